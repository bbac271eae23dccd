#include "framework/study/pipeline/exact_posteriors.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "framework/analysis/metrics.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The smallest of the depths below which lies a share of the weight.
double calcDepthOf(const VectorXd& depths, const VectorXd& weights, double probability) {
  double held = 0.0;
  for (const Index i : sortIndices(depths.size(), [&](Index a, Index b) { return depths[a] < depths[b]; })) {
    held += weights[i];
    if (held >= probability) {
      return depths[i];
    }
  }
  return depths.maxCoeff();
}

int calcMedianSimulationsOf(const std::vector<SimulatorPosterior>& posteriors) {
  std::vector<int> simulations;
  for (const SimulatorPosterior& one : posteriors) {
    simulations.push_back(one.simulations);
  }
  return calcMedian(std::move(simulations));
}

/// How many measurements are done, from any thread.
class SharedProgress {
 public:
  SharedProgress(const RunControl& control, int total) : control_(control), total_(total) {}

  void advance() {
    const std::lock_guard<std::mutex> guard(lock_);
    ++done_;
    if (control_.progress) {
      control_.progress({"posteriors", done_, total_, 0, static_cast<double>(done_) / total_, false});
    }
  }

 private:
  const RunControl& control_;
  std::mutex lock_;
  int done_ = 0, total_;
};

bool isApart(const Refined& refined, const SimulatorPosterior& posterior, Index parameters) {
  constexpr double kApart = 0.3;  // of the posterior's sd
  const Eigen::ArrayXd sd = posterior.stddev.head(parameters);
  const Eigen::ArrayXd moved = (refined.point.head(parameters) - posterior.mean.head(parameters)).array();
  const Eigen::ArrayXd wider = refined.stddev.head(parameters).array() - sd;
  return ((moved.abs() > kApart * sd) || (wider.abs() > kApart * sd)).any();
}

}  // namespace

IntervalFactor calcDrawnFactor(const VectorXd& values, const VectorXd& weights, double mean, double stddev) {
  const VectorXd depths = (values.array() - mean).abs() / stddev;
  return {calcDepthOf(depths, weights, 0.5), calcDepthOf(depths, weights, 0.95)};
}

std::vector<SimulatorPosterior> sampleTestPosteriors(const Study& study, const LabelledFeatures& test,
                                                     Index count, int draws, VectorXd* seconds) {
  using Clock = std::chrono::steady_clock;
  const RefinementModel model(collectUnknown(study.experiment.model), study.extractor, study.noise);
  const VectorXd center = calcBoxCenter(collectSampled(study.experiment.model));
  const Index known = test.inputs.rows(), unknown = center.size() - known;
  SimulatorPosteriorOptions options;
  options.draws = draws;
  options.seed = study.experiment.seed;
  std::vector<SimulatorPosterior> posteriors(static_cast<std::size_t>(count));
  VectorXd times(count);
  SharedProgress progress(study.control, static_cast<int>(count));
  runOnTeam(study.simulator, static_cast<int>(count), study.control.threads,
            [&](Simulator& simulator, int i) {
              throwIfCancelled(study.control, "interrupted while posteriors were sampled");
              VectorXd held = center;
              if (known > 0) {
                held.tail(known) = test.inputs.col(i);
              }
              const auto start = Clock::now();
              posteriors[static_cast<std::size_t>(i)] =
                  samplePosterior(simulator, model, study.experiment.model.priors, test.features.col(i), held,
                                  MatrixXd(unknown, 0), options);
              times[i] = std::chrono::duration<double>(Clock::now() - start).count();
              progress.advance();
            });
  if (seconds != nullptr) {
    *seconds = std::move(times);
  }
  return posteriors;
}

ReliablePosteriors takeReliable(const std::vector<SimulatorPosterior>& posteriors, Index parameters) {
  ReliablePosteriors reliable;
  for (std::size_t i = 0; i < posteriors.size(); ++i) {
    if (posteriors[i].isReliable()) {
      reliable.samples.push_back(static_cast<Index>(i));
    }
  }
  const auto count = static_cast<Index>(reliable.samples.size());
  Estimates& estimates = reliable.estimates;
  estimates.mean.resize(parameters, count);
  estimates.stddev.resize(parameters, count);
  estimates.interval_factors = {MatrixXd(parameters, count), MatrixXd(parameters, count)};
  for (Index i = 0; i < count; ++i) {
    const SimulatorPosterior& one =
        posteriors[static_cast<std::size_t>(reliable.samples[static_cast<std::size_t>(i)])];
    estimates.mean.col(i) = one.mean.head(parameters);
    estimates.stddev.col(i) = one.stddev.head(parameters);
    estimates.correlations.push_back(calcCorrelation(one.covariance.topLeftCorner(parameters, parameters)));
    for (Index p = 0; p < parameters; ++p) {
      estimates.interval_factors.set(
          p, i, calcDrawnFactor(one.draws.row(p), one.weights, one.mean[p], one.stddev[p]));
    }
  }
  return reliable;
}

MethodSummary summarizePosteriors(const std::vector<ParameterSpec>& parameters, const MatrixXd& truth,
                                  const std::vector<SimulatorPosterior>& posteriors,
                                  const MatrixXd& limit_stddev) {
  constexpr std::size_t kMin = 3;  // for a standard error
  const ReliablePosteriors reliable = takeReliable(posteriors, static_cast<Index>(parameters.size()));
  MethodSummary summary{"posterior",
                        static_cast<Index>(posteriors.size()),
                        static_cast<Index>(reliable.samples.size()),
                        calcMedianSimulationsOf(posteriors),
                        {}};
  if (reliable.samples.size() < kMin) {
    summary.accepted = 0;
    summary.metrics.assign(parameters.size(), {});
    return summary;
  }
  summary.metrics = calcMetrics(
      parameters, truth(Eigen::all, reliable.samples), reliable.estimates,
      limit_stddev.cols() > 0 ? MatrixXd(limit_stddev(Eigen::all, reliable.samples)) : MatrixXd());
  return summary;
}

PosteriorDifference compareRefined(const std::vector<Refined>& refined,
                                   const std::vector<SimulatorPosterior>& posteriors, Index parameters) {
  PosteriorDifference difference;
  for (std::size_t i = 0; i < std::min(refined.size(), posteriors.size()); ++i) {
    if (refined[i].isAccepted() && posteriors[i].isReliable()) {
      ++difference.compared;
      difference.apart += isApart(refined[i], posteriors[i], parameters) ? 1 : 0;
    }
  }
  return difference;
}

}  // namespace twinmap
