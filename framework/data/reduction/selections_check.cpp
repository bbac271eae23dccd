#include <fmt/core.h>

#include <algorithm>

#include "framework/data/reduction/selections.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

// How many inputs a step asks for; none where it takes what comes.
template <class Kind>
std::optional<int> getCount(const Kind&) {
  return {};
}
std::optional<int> getCount(const PrincipalComponentsSpec& spec) {
  return spec.components.number;
}
std::optional<int> getCount(const PartialLeastSquaresSpec& spec) {
  return spec.components.number;
}
std::optional<int> getCount(const MutualInformationSpec& spec) {
  return spec.count;
}
std::optional<int> getCount(const FisherInformationSpec& spec) {
  return spec.count;
}
template <class... Kinds>
std::optional<int> getCount(const std::variant<Kinds...>& step) {
  return std::visit([](const auto& kind) { return getCount(kind); }, step);
}

/// The names by which a step selects features; null where it does not.
const FeatureNames* findNames(const TransformStepSpec& step) {
  const auto* select = std::get_if<SelectSpec>(&step.kind);
  return select == nullptr ? nullptr : std::get_if<FeatureNames>(select);
}

}  // namespace

void checkTransformOf(const std::vector<FeatureInfo>& infos, const std::vector<TransformStepSpec>& steps) {
  auto most = static_cast<Index>(infos.size());
  for (const TransformStepSpec& step : steps) {
    const Index count = getCount(step.kind).value_or(0);
    if (count > most) {
      throw ExperimentError(step.where, std::to_string(count),
                            fmt::format("asks for more than the {} inputs of the step", most));
    }
    most = count > 0 ? count : most;
    if (const FeatureNames* names = findNames(step)) {
      most = std::min(most, static_cast<Index>(selectByName(*names, infos).size()));
    }
  }
}

}  // namespace twinmap
