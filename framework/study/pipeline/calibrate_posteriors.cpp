#include "framework/study/pipeline/calibrate_posteriors.hpp"

#include <fmt/core.h>

#include "framework/base/log/notice.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/trained/posterior_model.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

/// Ranks of the measurements whose posterior is reliable, in their order.
struct RankedMeasurements {
  Eigen::MatrixXi ranks;  // p + 1 x n
  int unreliable = 0;
};

/// Of each test sample; empty where its posterior is not reliable.
std::vector<Eigen::VectorXi> rankAll(const Study& study, const PreparedData& data,
                                     const PosteriorModel& model) {
  const LabelledFeatures& test = data.labelled.test;
  std::vector<Eigen::VectorXi> ranks(static_cast<std::size_t>(test.features.cols()));
  runTasks(study.control.threads, ranks.size(), [&](std::size_t i) {
    throwIfCancelled(study.control,
                     "interrupted during the calibration of posteriors; the simulated samples are kept");
    PosteriorSampler sampler(model, kDefaultPosteriorDraws, study.experiment.seed);
    const auto column = static_cast<Index>(i);
    const SurrogatePosterior posterior = sampler.sampleFeatures(
        test.features.col(column), test.inputs.col(column), static_cast<std::uint64_t>(data.test_indices[i]));
    if (posterior.isReliable()) {
      ranks[i] = calcRanks(test.parameters.col(column), posterior.draws.topRows(model.parameters),
                           {posterior.normal_mean, posterior.normal_covariance});
    }
  });
  return ranks;
}

RankedMeasurements collect(const std::vector<Eigen::VectorXi>& all, Index quantities) {
  RankedMeasurements ranked{Eigen::MatrixXi(quantities, static_cast<Index>(all.size())), 0};
  Index kept = 0;
  for (const Eigen::VectorXi& one : all) {
    if (one.size() > 0) {
      ranked.ranks.col(kept++) = one;
    }
  }
  ranked.unreliable = static_cast<int>(ranked.ranks.cols() - kept);
  ranked.ranks.conservativeResize(Eigen::NoChange, kept);
  return ranked;
}

/// Too many that are left out, and what the ranks of the others show.
void warn(const PosteriorCalibration& calibration, const std::vector<ParameterSpec>& parameters,
          StageNotes& notes) {
  constexpr double kMany = 0.05;  // of the measurements
  if (calibration.unreliable > kMany * (calibration.measurements + calibration.unreliable)) {
    notes.warn(makeWarning(Notice::kPosteriorsUnreliable, calibration.unreliable,
                           calibration.measurements + calibration.unreliable));
  }
  std::string named;
  for (const Index q : findMiscalibrated(calibration.ranks)) {
    const bool joint = q == static_cast<Index>(parameters.size());
    named += fmt::format("{}{} (p = {:.1e})", named.empty() ? "" : ", ",
                         joint ? "all together" : parameters[static_cast<std::size_t>(q)].name.text,
                         calibration.ranks.p_value[q]);
  }
  if (!named.empty()) {
    notes.warn(makeWarning(Notice::kPosteriorsUncalibrated, named));
  }
}

}  // namespace

CalibratedPosteriors calibratePosteriors(const Study& study, const PreparedData& data,
                                         const TrainedMap& map) {
  CalibratedPosteriors result;
  const std::optional<PosteriorModel> model = findPosteriorModel(OnlineMap(map.online.map), map.online.trust);
  if (!model) {
    result.notes.warn(makeWarning(Notice::kNoCalibration, "the run has no surrogate"));
    return result;
  }
  const Index quantities = model->parameters + 1;
  const RankedMeasurements ranked = timeStage("calibration of posteriors", result.notes, [&] {
    return collect(rankAll(study, data, *model), quantities);
  });
  if (ranked.ranks.cols() < kMinRanks) {
    result.notes.warn(
        makeWarning(Notice::kNoCalibration,
                    fmt::format("{} of {} test samples have a reliable posterior, {} are needed",
                                ranked.ranks.cols(), ranked.ranks.cols() + ranked.unreliable, kMinRanks)));
    return result;
  }
  result.calibration = PosteriorCalibration{static_cast<int>(ranked.ranks.cols()), ranked.unreliable,
                                            calcRankCalibration(ranked.ranks)};
  warn(*result.calibration, study.experiment.model.parameters, result.notes);
  return result;
}

}  // namespace twinmap
