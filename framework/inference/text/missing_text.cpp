#include <fmt/format.h>

#include <cmath>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/inference/text/explain_notice.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

using Eigen::Index;

namespace {

/// "c would fall by 99 of its sds": the parameter that a term moves most.
std::string describeShift(const Eigen::VectorXd& shifts, const std::vector<ParameterSpec>& parameters) {
  Index most = 0;
  const double size = shifts.cwiseAbs().maxCoeff(&most);
  return fmt::format("{} would {} by {:.3g} of its sds", parameters[static_cast<std::size_t>(most)].name.text,
                     shifts[most] < 0.0 ? "fall" : "rise", size);
}

}  // namespace

std::string explainMissingTerm(const MissingTerm& missing, const std::vector<ParameterSpec>& parameters) {
  const std::string rivals =
      missing.rivals.empty() ? "" : fmt::format("; {} would do as well", listNames(missing.rivals));
  return explainNotice(Notice::kMissingTerm, missing.term, missing.meaning,
                       describeShift(missing.shifts, parameters) + rivals);
}

std::string describeUnnoticed(const std::optional<ModelTest>& test,
                              const std::vector<ParameterSpec>& parameters) {
  if (!test || !test->unnoticed || !(test->unnoticed->shift > kNoticeable)) {
    return "";
  }
  const UnnoticedTerm& term = *test->unnoticed;
  return fmt::format("  could go unnoticed: {} below {}{} ({} by up to {:.3g} of its sds)\n", term.term,
                     toShortText(term.size, kRoughDigits), term.unit.empty() ? "" : " " + term.unit,
                     parameters[term.parameter].name.text, term.shift);
}

}  // namespace twinmap
