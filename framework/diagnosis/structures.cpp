#include "framework/diagnosis/structures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "framework/base/log/search_stage.hpp"
#include "framework/diagnosis/held_out.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// log of the share of the bounds that the posterior takes, as a normal distribution within a wide one of the
/// bounds' half-widths.
double calcLogOccupied(const RecordingsProblem& problem, const VectorXd& best) {
  const BoundedInformation information(problem.linearize(best).jacobian,
                                       0.5 * calcWidths(problem.getUnknown()));
  const auto u = static_cast<double>(best.size());
  // integral of exp(-d' H d / 2) over the bounds' volume, 2 in each direction
  return 0.5 * u * std::log(2.0 * M_PI) - 0.5 * information.calcLogDeterminant() - u * std::log(2.0);
}

/// The log determinants of the noise of recordings whose excitation is noisy: that acts by the structure's
/// own response.
double calcLogNoise(const RecordingsProblem& problem, const RecordedFeatures& recordings) {
  double sum = 0.0;
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    const OwnSetup* own = recordings.findOwn(k);
    const std::optional<NoiseWhitener>& whitener = problem.get().trials[k].model->getWhole().whitener;
    if (own != nullptr && own->stated.common.size() > 0 && whitener) {
      const MatrixXd matrix = whitener->makeMatrix();
      sum -= linalg::calcLogDeterminant(matrix * matrix.transpose()).log_size;
    }
  }
  return sum;
}

/// The time from which on the last third of the samples lie.
double findLastThird(const std::vector<FeatureInfo>& infos) {
  std::vector<double> times;
  for (const FeatureInfo& info : infos) {
    times.push_back(info.time);
  }
  std::sort(times.begin(), times.end());
  const double from = times[2 * times.size() / 3];
  if (!(from > times.front())) {
    throw std::runtime_error(
        "features without times cannot be held out: give two or more recordings, of which each is predicted "
        "by the others");
  }
  return from;
}

/// Of several recordings: each predicted by the others.
void holdOutEach(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                 const SimulatorPosteriorOptions& options, StructureFit& fit) {
  double squares = 0.0;
  SearchStage stage("predict each recording by the others", static_cast<int>(recordings.features.size()));
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    const HeldOutPrediction prediction = predictHeldOut(
        experiment, recordings.select({k}), inferMachine(experiment, recordings.leaveOut(k), options));
    squares += prediction.rms * prediction.rms;
    fit.held_out_p = std::min(fit.held_out_p, prediction.p_value);
    stage.advance();
  }
  fit.held_out_rms = std::sqrt(squares / static_cast<double>(recordings.features.size()));
}

/// Of a single recording: its last third.
void holdOutEnd(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                const std::vector<FeatureInfo>& infos, const SimulatorPosteriorOptions& options,
                StructureFit& fit) {
  const SearchStage stage("predict the last third by what is before it");
  const double from = findLastThird(infos);
  RecordedFeatures before = recording;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].time >= from) {
      before.features.front()[static_cast<Index>(i)] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  const HeldOutPrediction prediction =
      predictHeldOut(experiment, recording, inferMachine(experiment, before, options), from);
  fit.held_out_rms = prediction.rms;
  fit.held_out_p = prediction.p_value;
}

}  // namespace

StructureFit calcStructureFit(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const SimulatorPosteriorOptions& options) {
  const RecordingsProblem problem(experiment, recordings);
  const auto u = static_cast<Index>(problem.getUnknown().size());
  const SimulatorPosterior posterior = samplePosterior(problem.get(), MatrixXd(u, 0), options);
  if (posterior.best.size() == 0) {
    throw std::runtime_error(posterior.message);
  }
  StructureFit fit;
  fit.chi_square = posterior.chi_square;
  fit.degrees = posterior.degrees;
  fit.log_evidence = -0.5 * (posterior.misfit + calcLogNoise(problem, recordings)) +
                     calcLogOccupied(problem, posterior.best);
  if (recordings.features.size() > 1) {
    holdOutEach(experiment, recordings, options, fit);
  } else {
    const std::vector<FeatureInfo>& infos = problem.getSimulator().getExtractor().getInfos();
    holdOutEnd(experiment, recordings, infos, options, fit);
  }
  return fit;
}

}  // namespace twinmap
