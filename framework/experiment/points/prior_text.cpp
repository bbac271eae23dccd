#include "framework/experiment/points/prior_text.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

std::string shorten(double value) {
  constexpr int kDigits = 6;
  return toShortText(value, kDigits);
}

std::string describeKind(const PriorSpec& prior, const Bounds& bounds) {
  if (const auto* normal = std::get_if<NormalPrior>(&prior.kind)) {
    return fmt::format("normal {} +- {}", shorten(normal->mean), shorten(normal->stddev));
  }
  if (const auto* lognormal = std::get_if<LognormalPrior>(&prior.kind)) {
    return fmt::format("lognormal {} within a factor of {}", shorten(lognormal->median),
                       shorten(lognormal->factor));
  }
  if (const auto* student = std::get_if<StudentPrior>(&prior.kind)) {
    return fmt::format("Student's t {} +- {}", shorten(student->location), shorten(student->scale));
  }
  const std::string range = fmt::format("from {} to {}", shorten(bounds.lower), shorten(bounds.upper));
  if (const auto* beta = std::get_if<BetaPrior>(&prior.kind)) {
    return fmt::format("beta({}, {}) {}", shorten(beta->alpha), shorten(beta->beta), range);
  }
  return "log-uniform " + range;
}

std::string describeGroup(const PriorGroupSpec& group) {
  if (const auto* pair = std::get_if<CorrelatedPriors>(&group.kind)) {
    return fmt::format("correlation of {} and {} {}", pair->names[0].text, pair->names[1].text,
                       shorten(pair->correlation));
  }
  std::string text;
  if (const auto* joint = std::get_if<JointNormalPrior>(&group.kind)) {
    const std::size_t n = joint->names.size();
    for (std::size_t k = 0; k < n; ++k) {
      text += fmt::format("{}{} normal {} +- {}", text.empty() ? "" : ", ", joint->names[k].text,
                          shorten(joint->mean[k]), shorten(std::sqrt(joint->covariance[k * n + k])));
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
      add(fmt::format("{} {}{}{}", parameter.name.text, describeKind(*parameter.prior, parameter.bounds),
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
