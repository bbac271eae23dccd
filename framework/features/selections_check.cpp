#include <algorithm>

#include "framework/features/selections.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

/// How many inputs a step asks for; none where it takes what comes.
std::optional<int> getCount(const TransformStepSpec& step) {
  if (step.principal_components) {
    return step.principal_components->components.number;
  }
  if (step.partial_least_squares) {
    return step.partial_least_squares->components.number;
  }
  if (step.select && step.select->mutual_information) {
    return step.select->mutual_information->count;
  }
  return step.select && step.select->fisher_information
             ? std::optional(step.select->fisher_information->count)
             : std::nullopt;
}

}  // namespace

void checkTransformOf(const std::vector<FeatureInfo>& infos, const std::vector<TransformStepSpec>& steps) {
  auto most = static_cast<Index>(infos.size());
  for (const TransformStepSpec& step : steps) {
    const Index count = getCount(step).value_or(0);
    if (count > most) {
      throw ExperimentError(step.where, std::to_string(count),
                            "asks for more than the " + std::to_string(most) + " inputs of the step");
    }
    most = count > 0 ? count : most;
    if (step.select && !step.select->features.empty()) {
      most = std::min(most, static_cast<Index>(selectByName(step.select->features, infos).size()));
    }
  }
}

}  // namespace twinmap
