#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "framework/base/log/log.hpp"
#include "framework/base/log/search_stage.hpp"
#include "framework/base/log/stage_notes.hpp"

namespace twinmap {

/// Logs a stage that took the given time, and notes it.
void noteStage(const std::string& name, std::chrono::steady_clock::duration elapsed, StageNotes& notes);

/// Runs a stage, names it when it begins (SearchStage), logs it and notes its wall time.
template <class Stage>
auto timeStage(const std::string& name, StageNotes& notes, const Stage& stage) {
  const SearchStage named(name);
  const auto start = std::chrono::steady_clock::now();
  auto result = stage();
  noteStage(name, std::chrono::steady_clock::now() - start, notes);
  return result;
}

}  // namespace twinmap
