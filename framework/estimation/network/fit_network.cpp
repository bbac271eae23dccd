#include "framework/estimation/network/fit_network.hpp"

#include <algorithm>
#include <utility>

#include "framework/estimation/network/canonical_inputs.hpp"
#include "kernels/network/train.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// Batches of noise: the steps of a run come first, those for other purposes far behind them.
constexpr std::uint64_t kRuns = std::uint64_t{1} << 32;
constexpr std::uint64_t kRegression = kRuns / 2, kHeldOut = kRegression + 1, kMeasured = kRegression + 2,
                        kPosterior = kRuns - 1;

// Draws of samples that a regression takes, or a posterior of weights at most.
constexpr Index kLeast = 4000, kMost = 20000;

// Of an ensemble: enough to tell apart what is known from what is guessed.
constexpr std::uint64_t kMembers = 5;

std::vector<Index> repeat(const std::vector<Index>& chosen, Index count) {
  std::vector<Index> repeated(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < repeated.size(); ++i) {
    repeated[i] = chosen[i % chosen.size()];
  }
  return repeated;
}

/// A draw of the noise of each of `chosen`.
network::Samples drawSamples(const NetworkSet& set, const std::vector<Index>& chosen,
                             const RandomStream& random, std::uint64_t batch) {
  network::Samples drawn{MatrixXd(set.samples.countInputs(), static_cast<Index>(chosen.size())),
                         set.targets(Eigen::all, chosen)};
  set.samples.draw(chosen, random, {batch, 0}, drawn.inputs);
  return drawn;
}

/// Batches of samples drawn at random, with replacement.
network::BatchSource makeSource(const NetworkSet& set, const std::vector<Index>& training,
                                const NetworkFitting& fitting) {
  const RandomStream order(fitting.seed, RandomPurpose::kNetworkBatches);
  const RandomStream noise(fitting.seed, RandomPurpose::kNetworkNoise);
  return [=, &set, &training, run = fitting.run](Index step, Index first, network::Samples& samples) {
    const auto count = static_cast<double>(training.size());
    const std::uint64_t batch = run * kRuns + static_cast<std::uint64_t>(step);
    std::vector<Index> chosen(static_cast<std::size_t>(samples.inputs.cols()));
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const double uniform = order.calcUniform(static_cast<std::uint64_t>(first) + i, 0, batch);
      chosen[i] = training[std::min(static_cast<std::size_t>(uniform * count), training.size() - 1)];
    }
    set.samples.draw(chosen, noise, {batch, first}, samples.inputs);
    samples.targets = set.targets(Eigen::all, chosen);
  };
}

/// Of the inputs that vary most: they save a network most of its work where a response is smooth. Fewer where
/// there are too few samples for them.
network::Products chooseProducts(Index inputs, Index samples) {
  constexpr Index kMaxSquared = 12, kMaxCubed = 8;
  network::Products products{std::min(inputs, kMaxSquared), std::min(inputs, kMaxCubed)};
  while (products.cubed > 0 && !sufficeFor(inputs, products, samples)) {
    --products.cubed;
  }
  while (products.squared > 0 && !sufficeFor(inputs, products, samples)) {
    --products.squared;
  }
  return products;
}

/// The network before its first step: the regression of several draws of each training sample.
network::Network makeInitial(const NetworkSet& set, const std::vector<Index>& training,
                             const NetworkFitting& fitting) {
  const Index count = std::clamp(static_cast<Index>(training.size()), kLeast, kMost);
  const network::Samples drawn =
      drawSamples(set, repeat(training, count), {fitting.seed, RandomPurpose::kNetworkNoise},
                  fitting.run * kRuns + kRegression);
  network::NetworkShape shape;
  shape.hidden = fitting.spec.hidden.value();
  shape.components = fitting.spec.countComponents();
  shape.products = chooseProducts(drawn.inputs.rows(), static_cast<Index>(training.size()));
  const RandomStream weights(fitting.seed, RandomPurpose::kNetworkWeights);
  return network::makeNetwork(drawn.inputs, drawn.targets, shape, [&](Index i) {
    return weights.calcNormal(static_cast<std::uint64_t>(i), 0, fitting.run);
  });
}

network::NetworkTraining train(const NetworkSet& set, const Split& split, const NetworkFitting& fitting,
                               const TrainingControl& control) {
  constexpr Index kChecked = 2000, kChecks = 40;
  const auto left = static_cast<Index>(split.held_out.size());
  const network::Samples checked =
      drawSamples(set, repeat(split.held_out, std::max(left, kChecked / left * left)),
                  {fitting.seed, RandomPurpose::kNetworkNoise}, fitting.run * kRuns + kHeldOut);
  network::TrainingOptions options;
  options.steps = fitting.spec.steps.value();
  options.batch = fitting.spec.batch.value();
  options.learning_rate = fitting.spec.learning_rate.value();
  options.check_interval = std::max<Index>(options.steps / kChecks, 1);
  options.threads = control.threads;
  options.stop = control.stop;
  return network::trainNetwork(makeInitial(set, split.training, fitting),
                               makeSource(set, split.training, fitting), checked, options);
}

/// One draw of the noise of each training sample, but of so many at most.
network::Samples drawOnce(const NetworkSet& set, const Split& split, const NetworkFitting& fitting) {
  std::vector<Index> chosen = split.training;
  chosen.resize(std::min(chosen.size(), static_cast<std::size_t>(kMost)));
  return drawSamples(set, chosen, {fitting.seed, RandomPurpose::kNetworkNoise},
                     fitting.run * kRuns + kPosterior);
}

/// Networks that begin at other weights and see other batches, with the posteriors of their last layers.
NetworkFit fitEnsemble(const NetworkSet& set, const Split& split, const NetworkFitting& fitting,
                       const TrainingControl& control) {
  std::vector<NetworkFit> fits(kMembers);
  runTasks(control.threads, fits.size(), [&](std::size_t i) {
    const NetworkFitting own{fitting.spec, fitting.seed, fitting.run * kMembers + i};
    network::NetworkTraining trained = train(set, split, own, {1, control.stop});
    const network::Samples drawn = drawOnce(set, split, own);
    fits[i].restarts = trained.restarts;
    fits[i].members.push_back(network::makeBayesian(std::move(trained.network), drawn.inputs, drawn.targets));
  });
  NetworkFit all;
  for (NetworkFit& fit : fits) {
    all.restarts += fit.restarts;
    all.members.push_back(std::move(fit.members.front()));
  }
  return all;
}

NetworkFit fitChains(const NetworkSet& set, const Split& split, const NetworkFitting& fitting,
                     const TrainingControl& control) {
  const network::NetworkTraining trained = train(set, split, fitting, control);
  const network::Samples drawn = drawOnce(set, split, fitting);
  NetworkFit fit{{}, trained.restarts, {}};
  SampledWeights sampled =
      sampleWeights(trained.network, drawn, fitting.spec, {fitting.seed, fitting.run}, control);
  for (network::Network& network : sampled.networks) {
    fit.members.push_back({std::move(network), {}});
  }
  fit.chains = std::move(sampled.chains);
  return fit;
}

}  // namespace

NetworkFit fitNetwork(const NetworkSet& set, const Split& split, const NetworkFitting& fitting,
                      const TrainingControl& control) {
  if (fitting.spec.bayesian == NetworkBayes::kLastLayer) {
    return fitEnsemble(set, split, fitting, control);
  }
  if (fitting.spec.bayesian == NetworkBayes::kHamiltonian) {
    return fitChains(set, split, fitting, control);
  }
  network::NetworkTraining trained = train(set, split, fitting, control);
  return {{{std::move(trained.network), {}}}, trained.restarts, {}};
}

MatrixXd drawMeasured(const NoisySamples& samples, const std::vector<Index>& chosen, Index draws,
                      std::uint64_t seed) {
  const auto n = static_cast<Index>(chosen.size());
  MatrixXd inputs(samples.countInputs(), n * draws);
  const RandomStream random(seed, RandomPurpose::kNetworkNoise);
  for (Index draw = 0; draw < draws; ++draw) {
    samples.draw(chosen, random, {kMeasured + static_cast<std::uint64_t>(draw), 0},
                 inputs.middleCols(draw * n, n));
  }
  return inputs;
}

}  // namespace twinmap
