#include <algorithm>
#include <utility>

#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

bool hasStatus(const std::vector<std::string>& statuses, Notice notice) {
  return std::find(statuses.begin(), statuses.end(), getNotice(notice).name) != statuses.end();
}

bool isAdvisedElse(const std::string& status, const std::vector<std::string>& statuses) {
  const std::vector<std::pair<Notice, Notice>> pairs{
      {Notice::kAtBounds, Notice::kMultimodal},      {Notice::kOutsideTraining, Notice::kMultimodal},
      {Notice::kUninformative, Notice::kMultimodal}, {Notice::kOutsideTraining, Notice::kAtBounds},
      {Notice::kUncalibrated, Notice::kNonlinear},   {Notice::kUncalibrated, Notice::kPosteriorUncalibrated},
      {Notice::kSensorOffset, Notice::kClockFault},  {Notice::kNoiseColoured, Notice::kClockFault},
      {Notice::kNoiseColoured, Notice::kMissingTerm}};
  return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return status == getNotice(pair.first).name && hasStatus(statuses, pair.second);
  });
}

}  // namespace twinmap
