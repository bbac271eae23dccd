// How right the simulator's posterior is on a mechanism: posterior_study FILE.yaml [tests] [draws] [seed]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

int run(const std::string& file, int tests, int draws, std::uint64_t seed) {
  const ExperimentSpec experiment = loadExperiment(file);
  const ResponseLayout layout = makeLayout(experiment);
  const FeatureExtractor extractor = makeExtractor(experiment, layout);
  const ResponseNoise response_noise(experiment.noise, layout);
  const FeatureNoise noise(extractor, response_noise, experiment.seed);
  const auto prototype = makeSimulator(experiment.model, layout.times, layout.modes);
  const auto simulator = prototype->clone();
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  const RefinementModel model(unknown, extractor, noise);
  const std::vector<ParameterSpec> sampled = collectSampled(experiment.model);
  const RandomStream random(seed, RandomPurpose::kTestDesign);
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  VectorXd c95 = VectorXd::Zero(p), c50 = c95, worst = c95, squares = c95;
  std::vector<double> seconds, sizes, simulations, modes;
  int good = 0, explained = 0, missed = 0;
  for (int i = 0; i < tests; ++i) {
    VectorXd truth(static_cast<Index>(sampled.size()));
    for (Index j = 0; j < truth.size(); ++j) {
      const Bounds& b = sampled[static_cast<std::size_t>(j)].bounds;
      truth[j] = b.lower + (b.upper - b.lower) * random.calcUniform(static_cast<std::uint64_t>(i),
                                                                    static_cast<std::uint64_t>(j));
    }
    MatrixXd response(layout.getRowCount(), 1);
    SampleStatus status;
    simulator->simulate(truth, response, &status);
    if (!status.ok) {
      continue;
    }
    const VectorXd clean = extractor.extract(response).col(0);
    const MatrixXd noisy = addNoise(response, response_noise,
                                    {seed + 1000 * static_cast<std::uint64_t>(i), RandomPurpose::kTestNoise});
    const VectorXd features = extractor.extract(noisy).col(0);
    if (!features.allFinite()) {
      continue;
    }
    const auto begin = std::chrono::steady_clock::now();
    SimulatorPosteriorOptions options;
    options.draws = draws;
    options.seed = experiment.seed;
    const SimulatorPosterior posterior =
        samplePosterior(*simulator, model, experiment.model.priors, features, truth,
                        MatrixXd(static_cast<Index>(unknown.size()), 0), options);
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    simulations.push_back(posterior.simulations);
    sizes.push_back(posterior.effective_sample_size);
    explained += posterior.isExplained();
    const NoiseWhitener whitener = model.makeWhitener(model.getWhole(), response);
    missed += posterior.chi_square > whitener.apply(VectorXd(features - clean)).squaredNorm() + 2.0;
    if (!posterior.isReliable()) {
      fmt::print("  {}: {} (ess {:.0f}, pareto {:.2f}, chi {:.1f}/{:.0f}, best found {} of {}) \n", i,
                 posterior.message, posterior.effective_sample_size, posterior.pareto_shape,
                 posterior.chi_square, posterior.degrees, posterior.found_best, posterior.starts);
      continue;
    }
    ++good;
    modes.push_back(static_cast<double>(posterior.modes.size()));
    VectorXd probabilities(4);
    probabilities << 0.025, 0.25, 0.75, 0.975;
    const MatrixXd q = posterior.calcQuantiles(probabilities);
    for (Index j = 0; j < p; ++j) {
      c95[j] += q(j, 0) <= truth[j] && truth[j] <= q(j, 3);
      c50[j] += q(j, 1) <= truth[j] && truth[j] <= q(j, 2);
      const double z = std::abs(posterior.mean[j] - truth[j]) / posterior.stddev[j];
      worst[j] = std::max(worst[j], z);
      squares[j] += z * z;
    }
  }
  const auto median = [](std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v.empty() ? 0.0 : v[v.size() / 2];
  };
  fmt::print(
      "{} tests {} reliable {} explained {} best basin missed {}  modes>1 {}  median: {:.3f} s, {:.0f} "
      "simulations, ess {:.0f}\n",
      file.substr(file.rfind('/') + 1), sizes.size(), good, explained, missed,
      std::count_if(modes.begin(), modes.end(), [](double m) { return m > 1; }), median(seconds),
      median(simulations), median(sizes));
  for (Index j = 0; j < p; ++j) {
    fmt::print("  {:>10} c95 {:.3f} c50 {:.3f} rms z {:.2f} worst {:.1f}\n",
               sampled[static_cast<std::size_t>(j)].name.text, c95[j] / good, c50[j] / good,
               std::sqrt(squares[j] / good), worst[j]);
  }
  return 0;
}

}  // namespace
}  // namespace twinmap

int main(int argc, char** argv) {
  return twinmap::run(argv[1], argc > 2 ? std::stoi(argv[2]) : 50, argc > 3 ? std::stoi(argv[3]) : 512,
                      argc > 4 ? std::stoull(argv[4]) : 1);
}
