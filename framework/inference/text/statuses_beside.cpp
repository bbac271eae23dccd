#include <algorithm>
#include <utility>

#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

bool isAdvisedElse(const std::string& status, const std::vector<std::string>& statuses) {
  const std::vector<std::pair<Notice, Notice>> pairs{
      {Notice::kAtBounds, Notice::kMultimodal},      {Notice::kOutsideTraining, Notice::kMultimodal},
      {Notice::kUninformative, Notice::kMultimodal}, {Notice::kOutsideTraining, Notice::kAtBounds},
      {Notice::kUncalibrated, Notice::kNonlinear},   {Notice::kUncalibrated, Notice::kPosteriorUncalibrated},
      {Notice::kNoiseColoured, Notice::kMissingTerm}};
  const auto is = [&](Notice notice) { return status == getNotice(notice).name; };
  const bool is_excused = (is(Notice::kSensorOffset) || is(Notice::kNoiseColoured)) &&
                          std::any_of(statuses.begin(), statuses.end(), [](const std::string& other) {
                            return getStatus(other).concern == Concern::kNuisance;
                          });
  return is_excused || std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
           return is(pair.first) && hasStatus(statuses, pair.second);
         });
}

}  // namespace twinmap
