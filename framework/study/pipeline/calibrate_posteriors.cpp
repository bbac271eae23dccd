#include "framework/study/pipeline/calibrate_posteriors.hpp"

#include <fmt/core.h>

#include "framework/base/log/notice.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/log_coordinates.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/trained/posterior_model.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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

/// Independent draws of the weighted ones (u x kRankDraws), others of each measurement.
MatrixXd drawEqually(const SimulatorPosterior& posterior, std::uint64_t seed, std::uint64_t sample) {
  const RandomStream random(seed, RandomPurpose::kPosteriorResampling);
  const VectorXd uniforms = VectorXd::NullaryExpr(
      kRankDraws, [&](Index i) { return random.calcUniform(sample, static_cast<std::uint64_t>(i)); });
  return posterior.resample(uniforms);
}

/// The ranks of a truth (p) among them. Distances are taken in the coordinates and the linear model of the
/// best point, which no draw has part in.
Eigen::VectorXi rankExact(const SimulatorPosterior& posterior, const LogCoordinates& coordinates,
                          const VectorXd& truth, const MatrixXd& draws) {
  const Index p = truth.size();
  const MatrixXd covariance = BoundedInformation(posterior.information).calcCovariance().topLeftCorner(p, p);
  VectorXd point = posterior.best;
  const VectorXd center = coordinates.fromParameters(point).head(p);
  point.head(p) = truth;
  const VectorXd at = coordinates.fromParameters(point).head(p);
  MatrixXd points(p, draws.cols());
  for (Index i = 0; i < draws.cols(); ++i) {
    points.col(i) = coordinates.fromParameters(draws.col(i)).head(p);
  }
  return calcRanks(at, points, {center, covariance});
}

std::vector<Eigen::VectorXi> rankAllExact(const Study& study, const LabelledFeatures& test,
                                          const std::vector<SimulatorPosterior>& posteriors) {
  const LogCoordinates coordinates(collectUnknown(study.experiment.model));
  std::vector<Eigen::VectorXi> ranks(posteriors.size());
  for (std::size_t i = 0; i < posteriors.size(); ++i) {
    if (posteriors[i].isReliable()) {
      ranks[i] = rankExact(posteriors[i], coordinates, test.parameters.col(static_cast<Index>(i)),
                           drawEqually(posteriors[i], study.experiment.seed, i));
    }
  }
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

/// Histograms and tests of the ranks, or why there are none.
void calibrate(const RankedMeasurements& ranked, const std::vector<ParameterSpec>& parameters,
               CalibratedPosteriors& result) {
  const auto reliable = static_cast<int>(ranked.ranks.cols());
  if (reliable < kMinRanks) {
    result.notes.warn(makeWarning(
        Notice::kNoCalibration, fmt::format("{} of {} test samples have a reliable posterior, {} are needed",
                                            reliable, reliable + ranked.unreliable, kMinRanks)));
    return;
  }
  result.calibration = PosteriorCalibration{reliable, ranked.unreliable, calcRankCalibration(ranked.ranks)};
  warn(*result.calibration, parameters, result.notes);
}

}  // namespace

CalibratedPosteriors calibratePosteriors(const Study& study, const PreparedData& data,
                                         const TrainedMap& map) {
  CalibratedPosteriors result;
  const std::optional<PosteriorModel> model =
      findPosteriorModel(*map.online.map, map.online.trust, study.experiment.model);
  if (!model) {
    result.notes.warn(makeWarning(Notice::kNoCalibration, "the run has no surrogate"));
    return result;
  }
  const RankedMeasurements ranked = timeStage("calibration of posteriors", result.notes, [&] {
    return collect(rankAll(study, data, *model), model->parameters + 1);
  });
  calibrate(ranked, study.experiment.model.parameters, result);
  return result;
}

CalibratedPosteriors calibratePosteriors(const Study& study, const LabelledFeatures& test,
                                         const std::vector<SimulatorPosterior>& posteriors) {
  CalibratedPosteriors result;
  calibrate(collect(rankAllExact(study, test, posteriors), test.parameters.rows() + 1),
            study.experiment.model.parameters, result);
  return result;
}

}  // namespace twinmap
