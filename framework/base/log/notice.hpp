#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

#include "framework/base/log/warning.hpp"

namespace twinmap {

/// What twinmap says beside its numbers: each status of an estimate and each warning of a run or a command.
/// All are listed in notice.cpp, from which `twinmap explain` and docs/reference/statuses-and-warnings.md are
/// made; tests/framework/cli/notices.yaml has an example that produces each.
enum class Notice {
  kOk,
  kModelMismatch,
  kModelIncomplete,
  kMissingTerm,
  kOutsideTraining,
  kAtBounds,
  kUninformative,
  kOutliers,
  kClockFault,
  kNoiseLarger,
  kNoiseSmaller,
  kNoiseColoured,
  kSensorOffset,
  kMultimodal,
  kTrialsDisagree,
  kUncalibrated,
  kPosteriorUncalibrated,
  kNonlinear,
  kNotRefined,
  kEstimatorLimited,
  kUnreliable,
  kNotSimulated,
  kError,
  // of a run, or before it
  kSamplesFailed,
  kAllFailed,
  kStiff,
  kNoEffect,
  kIntervalsTooNarrow,
  kIntervalsTooWide,
  kMultimodalTests,
  kAboveLimit,
  kMoreSamplesHardlyHelp,
  kDataUninformative,
  kNotDetermined,
  kConfounded,
  kCorrelated,
  kNoLimit,
  kLimitFailed,
  kNoTrustModel,
  kBlindSpots,
  kFewRefined,
  kCannotRefine,
  kSurrogateRescaled,
  kSurrogateUncalibrated,
  kHyperparametersAtBound,
  kRestarts,
  kChains,
  kShape,
  kTeacherFar,
  kStudentFar,
  kNotCompared,
  kPosteriorsUnreliable,
  kPosteriorsUncalibrated,
  kNoCalibration,
  kUnconverged,
  kExactPosterior,
  kPosteriorDiffers,
  kUnfinishedTraining,
  kNuisanceSearch,
  kRelativeToRange,
  kPlainSweep,
  kOtherBuild,
  kSetAside
};

/// What of a recording, not of the machine, a status names: samples and noise of its sensors, or a nuisance
/// that is inferred with the parameters.
enum class Concern { kOther, kSensor, kNuisance };

/// What a status or warning says and means.
struct NoticeText {
  Notice notice;
  const char* name;      ///< "model_mismatch"
  bool is_status;        ///< of an estimate; else a warning
  Severity severity;     ///< how much it matters
  const char* happened;  ///< its first line, with places {0}, {1} ... for numbers and names
  const char* remedy;    ///< its second line: the one thing to do; "" where nothing need be done
  const char* cause;     ///< how it comes about
  Concern concern = Concern::kOther;
};

/// All, in the order of Notice.
const std::vector<NoticeText>& listNotices();
const NoticeText& getNotice(Notice notice);
/// That of kOk for a name that none has.
const NoticeText& getStatus(const std::string& name);

/// "what happened\n  what to do", its places filled with the arguments.
template <class... Arguments>
std::string describeNotice(Notice notice, const Arguments&... arguments) {
  const NoticeText& text = getNotice(notice);
  const std::string happened = fmt::format(fmt::runtime(text.happened), arguments...);
  return *text.remedy == '\0' ? happened
                              : happened + "\n  " + fmt::format(fmt::runtime(text.remedy), arguments...);
}

/// Whether a text is that of a notice, whatever fills its places.
bool saysNotice(const std::string& text, Notice notice);

/// Whether the text of a warning says that nothing need be done: a remark.
bool isRemark(const std::string& text);

/// The warning, of the severity that is listed.
template <class... Arguments>
Warning makeWarning(Notice notice, const Arguments&... arguments) {
  return {getNotice(notice).severity, describeNotice(notice, arguments...)};
}

}  // namespace twinmap
