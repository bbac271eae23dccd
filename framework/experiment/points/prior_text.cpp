#include "framework/experiment/points/prior_text.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/prior_marginal.hpp"

namespace twinmap {
namespace {

std::string describeGroup(const PriorGroupSpec& group) {
  if (const auto* pair = std::get_if<CorrelatedPriors>(&group.kind)) {
    return fmt::format("correlation of {} and {} {}", pair->names[0].text, pair->names[1].text,
                       shortenOfPrior(pair->correlation));
  }
  std::string text;
  if (const auto* joint = std::get_if<JointNormalPrior>(&group.kind)) {
    const std::size_t n = joint->names.size();
    for (std::size_t k = 0; k < n; ++k) {
      text += fmt::format("{}{} normal {} +- {}", text.empty() ? "" : ", ", joint->names[k].text,
                          shortenOfPrior(joint->mean[k]),
                          shortenOfPrior(std::sqrt(joint->covariance[k * n + k])));
    }
    text += n > 1 ? " (jointly)" : "";
  }
  return text;
}

}  // namespace

std::string describePriors(const ModelSpec& model) {
  std::string text;
  const auto add = [&](const std::string& phrase) { text += (text.empty() ? "" : ", ") + phrase; };
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  std::size_t stated = 0;
  for (const ParameterSpec& parameter : unknown) {
    if (parameter.prior) {
      ++stated;
      add(fmt::format("{} {}{}{}", parameter.name.text, describeMarginal(*parameter.prior, parameter.bounds),
                      parameter.unit.empty() ? "" : " ", parameter.unit));
    }
  }
  for (const PriorGroupSpec& group : model.priors) {
    const auto* joint = std::get_if<JointNormalPrior>(&group.kind);
    stated += joint != nullptr ? joint->names.size() : 0;
    add(describeGroup(group));
  }
  return text.empty() || stated == unknown.size() ? text : text + "; the others uniform within their bounds";
}

}  // namespace twinmap
