#include "bench/framework/estimation/posterior_bench.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "framework/analysis/information_limit.hpp"
#include "framework/analysis/rank_calibration.hpp"
#include "framework/base/random/random.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/measurement/direct_inference.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A machine is not integrated with the errors of its model.
ModelSpec tighten(ModelSpec model) {
  constexpr double kTighter = 1e-2, kLeastRelative = 1e-13, kLeastAbsolute = 1e-18;
  SimulationSpec& simulation = model.simulation;
  simulation.relative_tolerance = std::max(kLeastRelative, kTighter * simulation.relative_tolerance);
  simulation.absolute_tolerance = std::max(kLeastAbsolute, kTighter * simulation.absolute_tolerance);
  return model;
}

bool holds(const Intervals& intervals, double truth) {
  return std::any_of(intervals.begin(), intervals.end(), [&](const auto& interval) {
    return interval.first <= truth && truth <= interval.second;
  });
}

std::string joinRidges(const std::vector<Ridge>& ridges, const std::vector<ParameterSpec>& parameters) {
  std::string joined;
  for (const DerivedEntry& entry : listDerived(ridges, parameters)) {
    joined += (joined.empty() ? "" : ", ") + entry.expression;
  }
  return joined.empty() && !ridges.empty() ? "unnamed" : joined;
}

}  // namespace

std::string Judged::describe() const {
  const std::string named = ridges.empty() ? "" : ", name " + ridges;
  return fmt::format(
      "{}{}{} (effective {:.0f}, Pareto {:.2f}, chi-square {:.1f}, {:+.1f} to the truth's, found "
      "{} of {}, {:.2f} s)",
      missed ? "MISSED, " : "", status, named, size, pareto_shape, chi_square, excess, found_best, starts,
      seconds);
}

PosteriorBench::PosteriorBench(const StudyRequest& request)
    : request_(request),
      experiment_(followNoise(readExperimentWithSignals(loadExperimentTree(request.file)))),
      layout_(makeLayout(experiment_)),
      extractor_(makeExtractor(experiment_, layout_)),
      response_noise_(experiment_.noise, layout_),
      noise_(extractor_, response_noise_, experiment_.seed),
      machine_(makeSimulator(tighten(experiment_.model), layout_.times, layout_.modes)),
      unknown_(collectUnknown(experiment_.model)),
      sampled_(collectSampled(experiment_.model)),
      model_(unknown_, extractor_, noise_) {}

VectorXd PosteriorBench::drawTruth(int test) const {
  const RandomStream random(request_.seed, RandomPurpose::kTestDesign);
  VectorXd truth(static_cast<Index>(sampled_.size()));
  for (Index j = 0; j < truth.size(); ++j) {
    const ParameterSpec& parameter = sampled_[static_cast<std::size_t>(j)];
    const auto held = request_.held.find(parameter.name.text);
    const double uniform =
        random.calcUniform(static_cast<std::uint64_t>(test), static_cast<std::uint64_t>(j));
    truth[j] = held != request_.held.end()
                   ? held->second
                   : parameter.bounds.lower + (parameter.bounds.upper - parameter.bounds.lower) * uniform;
  }
  return truth;
}

std::optional<Measured> PosteriorBench::measure(int test, std::string& failure) const {
  Measured measured;
  measured.truth = drawTruth(test);
  MatrixXd stencil(layout_.getRowCount() * countNeighbours(unknown_.size()), 1);
  SampleStatus status;
  simulateStencils(*machine_, unknown_, measured.truth, stencil, &status);
  if (!status.ok) {
    failure = status.reason;
    return std::nullopt;
  }
  const LocalModel local = makeLocalModel(extractor_, unknown_, measured.truth, stencil, status);
  const MatrixXd noisy =
      addNoise(local.response, response_noise_,
               {request_.seed + 1000 * static_cast<std::uint64_t>(test), RandomPurpose::kTestNoise});
  measured.features = extractor_.extract(noisy).col(0);
  if (!measured.features.allFinite()) {
    failure = "a feature is not finite";
    return std::nullopt;
  }
  const NoiseWhitener whitener = model_.makeWhitener(model_.getWhole(), local.response);
  const VectorXd residual = model_.convert(measured.features) - model_.convert(local.features);
  measured.chi_square = whitener.apply(residual).squaredNorm();
  measured.limit = calcInformationLimit({local}, noise_, getParameters()).stddev.col(0);
  return measured;
}

InferredMeasurement PosteriorBench::infer(const Measured& measured, int draws, std::uint64_t seed) const {
  ExperimentSpec own = experiment_;
  own.seed = seed;
  const MeasurementReader reader(std::move(own));
  DirectInference inference(reader, draws);
  const Index known = measured.truth.size() - static_cast<Index>(unknown_.size());
  return inference.infer(measured.features, measured.truth.tail(known));
}

Judged PosteriorBench::judge(const Measured& measured, int test) const {
  const std::clock_t begin = std::clock();
  const InferredMeasurement inferred = infer(measured, request_.draws, experiment_.seed);
  const Estimate estimate = selectEstimate(inferred);
  Judged judged;
  judged.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const PosteriorEstimate& posterior = *inferred.posterior;
  judged.simulations = posterior.fit->simulations;
  judged.size = posterior.effective_sample_size;
  judged.pareto_shape = posterior.pareto_shape;
  judged.chi_square = posterior.fit->chi_square;
  judged.excess = posterior.fit->chi_square - measured.chi_square;
  judged.missed = !(judged.excess < 2.0);
  judged.found_best = posterior.fit->found_best;
  judged.starts = posterior.fit->searches;
  judged.status = joinStatuses(estimate.statuses, ", ");
  judged.ok = judged.status == "ok";
  judged.reliable = posterior.isReliable();
  judged.ridges = joinRidges(inferred.ridges, getParameters());
  if (judged.reliable) {
    compare(estimate, measured, test, judged);
    if (request_.reference > 0) {
      compareWithMore(estimate, measured, test, judged);
    }
  }
  return judged;
}

void PosteriorBench::compare(const Estimate& estimate, const Measured& measured, int test,
                             Judged& judged) const {
  const auto p = static_cast<Index>(getParameters().size());
  const VectorXd truth = measured.truth.head(p), widths = calcWidths(getParameters());
  const Eigen::ArrayXd error = estimate.mean - truth;
  judged.z = error / estimate.stddev.array();
  judged.error = error / widths.array();
  judged.stddev = estimate.stddev.cwiseQuotient(widths);
  judged.limit = measured.limit.head(p).cwiseQuotient(widths);
  judged.held95.resize(p);
  judged.held50.resize(p);
  for (Index j = 0; j < p; ++j) {
    judged.held95[j] = holds(estimate.findIntervals(j, Coverage::k95), truth[j]) ? 1.0 : 0.0;
    judged.held50[j] = holds(estimate.findIntervals(j, Coverage::k50), truth[j]) ? 1.0 : 0.0;
  }
  judged.ranks = rank(estimate, truth, test);
}

void PosteriorBench::compareWithMore(const Estimate& estimate, const Measured& measured, int test,
                                     Judged& judged) const {
  constexpr std::uint64_t kOther = 1000;
  const InferredMeasurement inferred =
      infer(measured, request_.reference, experiment_.seed + kOther + static_cast<std::uint64_t>(test));
  if (inferred.posterior->isReliable()) {
    const Estimate better = selectEstimate(inferred);
    judged.mean_error = (estimate.mean - better.mean).cwiseQuotient(better.stddev);
    judged.stddev_error = estimate.stddev.cwiseQuotient(better.stddev).array() - 1.0;
  }
}

/// Among draws of equal weight; together by the distance from the mean, in standard deviations: those are of
/// some 350 draws, so that the draws are hardly nearer to them than the truth is.
Eigen::VectorXi PosteriorBench::rank(const Estimate& estimate, const VectorXd& truth, int test) const {
  const RandomStream random(request_.seed, RandomPurpose::kPosteriorResampling);
  const VectorXd uniforms = VectorXd::NullaryExpr(kRankDraws, [&](Index i) {
    return random.calcUniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(test));
  });
  const MatrixXd draws = importance::resample({estimate.draws.points, estimate.draws.weights}, uniforms);
  const MatrixXd metric = estimate.stddev.cwiseAbs2().asDiagonal();
  return calcRanks(truth, draws.topRows(truth.size()), {estimate.mean, metric});
}

}  // namespace twinmap
