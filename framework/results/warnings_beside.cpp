#include "framework/results/warnings_beside.hpp"

#include <algorithm>

namespace twinmap {
namespace {

constexpr const char* kDone = "Nothing need be done: the estimates are refined.";

/// A remedy that is not given beside a notice.
struct Beside {
  const char* remedy;
  Notice notice;
};

constexpr Beside kBeside[] = {
    // it cannot be done, or was, and did not help
    {"Refine the estimates", Notice::kCannotRefine},
    {"Refine the estimates", Notice::kNoLimit},  // without noise
    {"Refine the estimates", Notice::kFewRefined},
    {kDone, Notice::kIntervalsTooNarrow},
    {kDone, Notice::kAboveLimit},
    {kDone, Notice::kPosteriorDiffers},
    // the test samples have said that they do not hold
    {"Nothing need be done; the run's test samples say", Notice::kIntervalsTooNarrow},
    // a surrogate is not advised whose errors are large or not known
    {"Use the surrogate itself", Notice::kSurrogateUncalibrated},
    {"Use the surrogate itself", Notice::kTeacherFar},
    // many more samples than the few hundred that hardly help
    {"Refine the estimates instead of adding samples", Notice::kTeacherFar},
};

/// Where the remedy that begins so stands in a text; npos where it does not.
std::size_t findRemedy(const std::string& text, const std::string& remedy) {
  return text.find("\n  " + remedy);
}

void markRefined(std::vector<Warning>& warnings) {
  for (Warning& warning : warnings) {
    const std::size_t remedy = findRemedy(warning.text, "Refine the estimates");
    if (remedy != std::string::npos) {
      warning.text = warning.text.substr(0, remedy) + "\n  " + kDone;
    }
  }
}

}  // namespace

void mendRemedies(std::vector<Warning>& warnings, bool are_refined) {
  if (are_refined) {
    markRefined(warnings);
  }
  for (const Beside& beside : kBeside) {
    const bool is_said = std::any_of(warnings.begin(), warnings.end(), [&](const Warning& warning) {
      return saysNotice(warning.text, beside.notice);
    });
    for (Warning& warning : warnings) {
      const std::size_t remedy = is_said ? findRemedy(warning.text, beside.remedy) : std::string::npos;
      if (remedy != std::string::npos) {
        warning.text.resize(remedy);
      }
    }
  }
}

}  // namespace twinmap
