// How right the simulator's posterior is on a mechanism:
//   posterior_study FILE.yaml [tests] [draws] [seed] [NAME=VALUE ...]
// simulates measurements of machines drawn from the bounds (with the parameters named held at their values),
// infers each without a run and prints what the statuses were, how often the intervals hold, the errors
// against the information limit, and simulation-based calibration.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <optional>
#include <string>

#include "framework/analysis/information_limit.hpp"
#include "framework/analysis/rank_calibration.hpp"
#include "framework/base/random/random.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/estimation/posterior/residual_test.hpp"
#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Request {
  std::string file;
  int tests = 60, draws = SimulatorPosteriorOptions{}.draws;
  std::uint64_t seed = 1;
  std::map<std::string, double> held;  ///< truths that are not drawn
};

/// A measurement of a machine that is known.
struct Measured {
  VectorXd truth;  ///< of the sampled box
  VectorXd features;
  double chi_square = 0.0;  ///< of the truth
  VectorXd limit;           ///< u: standard deviations
};

/// What the posterior said of it.
struct Judged {
  bool reliable = false, ok = false, missed = false;
  std::string status;
  VectorXd z, held95, held50;  ///< p; 1 where the interval holds
  VectorXd error, limit;       ///< p, in widths
  Eigen::VectorXi ranks;       ///< p + 1
  double seconds = 0.0, simulations = 0.0, size = 0.0, pareto_shape = 0.0;
  double chi_square = 0.0, excess = 0.0;  ///< of the best fit; above that of the truth
  int found_best = 0, starts = 0;

  std::string describe() const {
    return fmt::format(
        "{}{} (effective {:.0f}, Pareto {:.2f}, chi-square {:.1f}, {:+.1f} to the truth's, found "
        "{} of {}, {:.2f} s)",
        missed ? "MISSED, " : "", status, size, pareto_shape, chi_square, excess, found_best, starts,
        seconds);
  }
};

class Bench {
 public:
  explicit Bench(const Request& request)
      : request_(request),
        experiment_(loadExperiment(request.file)),
        layout_(makeLayout(experiment_)),
        extractor_(makeExtractor(experiment_, layout_)),
        response_noise_(experiment_.noise, layout_),
        noise_(extractor_, response_noise_, experiment_.seed),
        simulator_(makeSimulator(experiment_.model, layout_.times, layout_.modes)),
        unknown_(collectUnknown(experiment_.model)),
        sampled_(collectSampled(experiment_.model)),
        model_(unknown_, extractor_, noise_) {}

  const std::vector<ParameterSpec>& getParameters() const { return experiment_.model.parameters; }

  /// Nothing where the machine cannot be simulated.
  std::optional<Measured> measure(int test) {
    const RandomStream random(request_.seed, RandomPurpose::kTestDesign);
    Measured measured;
    measured.truth.resize(static_cast<Index>(sampled_.size()));
    for (Index j = 0; j < measured.truth.size(); ++j) {
      const ParameterSpec& parameter = sampled_[static_cast<std::size_t>(j)];
      const auto held = request_.held.find(parameter.name.text);
      const double uniform =
          random.calcUniform(static_cast<std::uint64_t>(test), static_cast<std::uint64_t>(j));
      measured.truth[j] =
          held != request_.held.end()
              ? held->second
              : parameter.bounds.lower + (parameter.bounds.upper - parameter.bounds.lower) * uniform;
    }
    MatrixXd stencil(layout_.getRowCount() * countNeighbours(unknown_.size()), 1);
    SampleStatus status;
    simulateStencils(*simulator_, unknown_, measured.truth, stencil, &status);
    if (!status.ok) {
      return std::nullopt;
    }
    const LocalModel local = makeLocalModel(extractor_, unknown_, measured.truth, stencil, status);
    const MatrixXd noisy =
        addNoise(local.response, response_noise_,
                 {request_.seed + 1000 * static_cast<std::uint64_t>(test), RandomPurpose::kTestNoise});
    measured.features = model_.convert(extractor_.extract(noisy).col(0));
    if (!measured.features.allFinite()) {
      return std::nullopt;
    }
    const NoiseWhitener whitener = model_.makeWhitener(model_.getWhole(), local.response);
    const VectorXd clean = model_.convert(local.features);
    measured.chi_square = whitener.apply(VectorXd(measured.features - clean)).squaredNorm();
    measured.limit = calcInformationLimit({local}, noise_, getParameters()).stddev.col(0);
    return measured;
  }

  /// With random numbers of its own: errors that all posteriors share would pass for miscalibration.
  Judged judge(const Measured& measured, int test) {
    SimulatorPosteriorOptions options;
    options.draws = request_.draws;
    options.seed = experiment_.seed + static_cast<std::uint64_t>(test);
    const std::clock_t begin = std::clock();
    const SimulatorPosterior posterior =
        samplePosterior(*simulator_, model_, experiment_.model.priors, measured.features, measured.truth,
                        MatrixXd(static_cast<Index>(unknown_.size()), 0), options);
    Judged judged;
    judged.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    judged.simulations = posterior.simulations;
    judged.size = posterior.effective_sample_size;
    judged.pareto_shape = posterior.pareto_shape;
    judged.chi_square = posterior.chi_square;
    judged.excess = posterior.chi_square - measured.chi_square;
    judged.missed = !(judged.excess < 2.0);
    judged.found_best = posterior.found_best;
    judged.starts = posterior.starts;
    judged.status = findStatus(posterior);
    judged.ok = judged.status == "ok";
    judged.reliable = posterior.isReliable();
    if (judged.reliable) {
      compare(posterior, measured, test, judged);
    }
    return judged;
  }

 private:
  std::string findStatus(const SimulatorPosterior& posterior) const {
    if (!(posterior.degrees > 0.0)) {
      return "not_simulated";
    }
    if (testResidual(model_.placeResidual(posterior.residual), posterior.degrees, extractor_.getInfos())
            .calcPValue() < kMismatchLevel) {
      return "model_mismatch";
    }
    if (!posterior.isReliable()) {
      return "unreliable: " + posterior.message;
    }
    return posterior.modes.size() > 1 ? "multimodal" : "ok";
  }

  void compare(const SimulatorPosterior& posterior, const Measured& measured, int test,
               Judged& judged) const {
    const auto p = static_cast<Index>(getParameters().size());
    const VectorXd truth = measured.truth.head(p), widths = calcWidths(getParameters());
    const Eigen::ArrayXd error = posterior.mean.head(p) - truth;
    judged.z = error / posterior.stddev.head(p).array();
    judged.error = error / widths.array();
    judged.limit = measured.limit.head(p).cwiseQuotient(widths);
    const auto hold = [&](double probability) { return findHeld(posterior, truth, probability); };
    judged.held95 = hold(0.95);
    judged.held50 = hold(0.5);
    judged.ranks = rank(posterior, truth, test);
  }

  /// 1 where the truth (p) is in the shortest of three intervals: the one with equal tails and those that end
  /// at a bound.
  VectorXd findHeld(const SimulatorPosterior& posterior, const VectorXd& truth, double probability) const {
    const double outside = 1.0 - probability;
    VectorXd probabilities(4);
    probabilities << 0.5 * outside, outside, probability, 1.0 - 0.5 * outside;
    const MatrixXd quantiles = posterior.calcQuantiles(probabilities);
    VectorXd held(truth.size());
    for (Index j = 0; j < held.size(); ++j) {
      const Bounds& bounds = unknown_[static_cast<std::size_t>(j)].bounds;
      Eigen::Matrix<double, 2, 3> intervals;
      intervals << quantiles(j, 0), bounds.lower, quantiles(j, 1),  //
          quantiles(j, 3), quantiles(j, 2), bounds.upper;
      Index shortest = 0;
      (intervals.row(1) - intervals.row(0)).minCoeff(&shortest);
      held[j] = intervals(0, shortest) <= truth[j] && truth[j] <= intervals(1, shortest) ? 1.0 : 0.0;
    }
    return held;
  }

  /// Among draws of equal weight; together by the distance from the best fit, in standard deviations.
  Eigen::VectorXi rank(const SimulatorPosterior& posterior, const VectorXd& truth, int test) const {
    const RandomStream random(request_.seed, RandomPurpose::kPosteriorResampling);
    const VectorXd uniforms = VectorXd::NullaryExpr(kRankDraws, [&](Index i) {
      return random.calcUniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(test));
    });
    const MatrixXd draws = importance::resample({posterior.draws, posterior.weights}, uniforms);
    const VectorXd center = posterior.best.head(truth.size());
    const MatrixXd metric = posterior.stddev.head(truth.size()).cwiseAbs2().asDiagonal();
    return calcRanks(truth, draws.topRows(truth.size()), {center, metric});
  }

  const Request request_;
  const ExperimentSpec experiment_;
  const ResponseLayout layout_;
  const FeatureExtractor extractor_;
  const ResponseNoise response_noise_;
  const FeatureNoise noise_;
  const std::unique_ptr<Simulator> simulator_;
  const std::vector<ParameterSpec> unknown_, sampled_;
  const RefinementModel model_;
};

double calcMedian(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

void printStatuses(const std::vector<Judged>& judged) {
  std::map<std::string, int> counts;
  int reliable = 0, missed = 0, wrong = 0;
  std::vector<double> seconds, simulations, sizes;
  for (const Judged& one : judged) {
    ++counts[one.status];
    reliable += one.reliable;
    missed += one.missed;
    wrong += one.ok && one.z.cwiseAbs().maxCoeff() > 6.0;
    seconds.push_back(one.seconds);
    simulations.push_back(one.simulations);
    sizes.push_back(one.size);
  }
  fmt::print(
      "  {} measurements, {} with a reliable posterior; best basin missed {}, ok and more than 6 sd off {}\n"
      "  median {:.3f} s of a processor (largest {:.2f}), {:.0f} simulations, effective sample size {:.0f}\n",
      judged.size(), reliable, missed, wrong, calcMedian(seconds),
      *std::max_element(seconds.begin(), seconds.end()), calcMedian(simulations), calcMedian(sizes));
  for (const auto& [status, count] : counts) {
    fmt::print("  {:5d} {}\n", count, status);
  }
}

/// Of reliable posteriors; ratio: of the errors to the information limit.
void printParameters(const std::vector<Judged>& judged, const std::vector<ParameterSpec>& parameters) {
  std::vector<const Judged*> good;
  for (const Judged& one : judged) {
    if (one.reliable) {
      good.push_back(&one);
    }
  }
  const auto n = static_cast<Index>(good.size()), p = static_cast<Index>(parameters.size());
  if (n == 0) {
    return;
  }
  VectorXd held95 = VectorXd::Zero(p), held50 = held95, errors = held95, limits = held95, worst = held95;
  Eigen::MatrixXi ranks(p + 1, n);
  for (Index i = 0; i < n; ++i) {
    const Judged& one = *good[static_cast<std::size_t>(i)];
    held95 += one.held95 / static_cast<double>(n);
    held50 += one.held50 / static_cast<double>(n);
    errors += one.error.cwiseAbs2();
    limits += one.limit.cwiseAbs2();
    worst = worst.cwiseMax(one.z.cwiseAbs());
    ranks.col(i) = one.ranks;
  }
  const VectorXd uniformity =
      n >= kMinRanks ? calcRankCalibration(ranks).p_value : VectorXd::Constant(p + 1, std::nan(""));
  for (Index j = 0; j < p; ++j) {
    fmt::print("  {:>10}  coverage95 {:.3f}  coverage50 {:.3f}  ratio {:.3f}  worst z {:.1f}  SBC p {:.3f}\n",
               parameters[static_cast<std::size_t>(j)].name.text, held95[j], held50[j],
               std::sqrt(errors[j] / limits[j]), worst[j], uniformity[j]);
  }
  fmt::print("  {:>10}  SBC p {:.3f}\n", "together", uniformity[p]);
}

Request readRequest(int argc, char** argv) {
  Request request;
  int position = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    if (const std::size_t equals = text.find('='); equals != std::string::npos) {
      request.held[text.substr(0, equals)] = std::stod(text.substr(equals + 1));
      continue;
    }
    switch (position++) {
      case 0:
        request.file = text;
        break;
      case 1:
        request.tests = std::stoi(text);
        break;
      case 2:
        request.draws = std::stoi(text);
        break;
      default:
        request.seed = std::stoull(text);
    }
  }
  return request;
}

int run(const Request& request) {
  Bench bench(request);
  std::vector<Judged> judged;
  for (int test = 0; test < request.tests; ++test) {
    if (const std::optional<Measured> measured = bench.measure(test)) {
      judged.push_back(bench.judge(*measured, test));
      if (!judged.back().reliable || judged.back().missed) {
        fmt::print("    {}: {}\n", test, judged.back().describe());
      }
    }
  }
  fmt::print("{}\n", request.file);
  if (!judged.empty()) {
    printStatuses(judged);
    printParameters(judged, bench.getParameters());
  }
  return 0;
}

}  // namespace
}  // namespace twinmap

int main(int argc, char** argv) {
  const twinmap::Request request = twinmap::readRequest(argc, argv);
  if (request.file.empty()) {
    fmt::print(stderr, "usage: posterior_study FILE.yaml [tests] [draws] [seed] [NAME=VALUE ...]\n");
    return 2;
  }
  return twinmap::run(request);
}
