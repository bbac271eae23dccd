#pragma once

#include <filesystem>

#include "framework/study/pipeline/preparation/study.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// Tells the map's trust model what its posteriors are worth, and writes maps.h5.
void storeMap(const std::filesystem::path& file, const Study& study, const Evaluation& evaluation,
              TrainedMap& map);

/// What intervals of test samples held, which a trust model remembers.
CoverageRecord recordCoverage(const MethodSummary& method);

/// What refined test samples tell a trust model: how many were not explained, and how badly.
RefinementReference collectReference(const std::vector<Refined>& refined);

}  // namespace twinmap
