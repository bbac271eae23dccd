#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <vector>

#include "kernels/linalg/parallel.hpp"

namespace twinmap {

/// Runs action(index) for every index below `count` on `threads` threads; throws what the first of those that
/// failed threw, which no parallel region may leave.
template <typename Action>
void runTasks(int threads, std::size_t count, const Action& action) {
  std::vector<std::exception_ptr> errors(count);
  const int team = static_cast<int>(std::min(static_cast<std::size_t>(threads), count));
  linalg::parallelFor(std::max(team, 1), static_cast<Eigen::Index>(count), 1, [&](Eigen::Index i, int) {
    try {
      action(static_cast<std::size_t>(i));
    } catch (...) {
      errors[static_cast<std::size_t>(i)] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error != nullptr) {
      std::rethrow_exception(error);
    }
  }
}

}  // namespace twinmap
