#include "framework/estimation/network/sample_weights.hpp"

#include <algorithm>

#include "framework/base/random/random.hpp"
#include "kernels/network/predictor.hpp"
#include "kernels/network/weight_density.hpp"
#include "kernels/sampling/nuts.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The random numbers of one chain.
struct ChainStream {
  RandomStream random;
  std::uint64_t stream;

  ChainStream(const ChainSeed& seed, std::size_t chain)
      : random(seed.seed, RandomPurpose::kNetworkChains), stream(seed.run * kMaxChains + chain) {}

  markov::ChainNumbers makeNumbers() const {
    return {[*this](Index i) { return random.calcNormal(static_cast<std::uint64_t>(i), kNormal, stream); },
            [*this](Index i) { return random.calcUniform(static_cast<std::uint64_t>(i), kUniform, stream); }};
  }

  VectorXd drawStart(const VectorXd& trained) const {
    constexpr double kApart = 0.1;
    return trained + kApart * VectorXd::NullaryExpr(trained.size(), [&](Index i) {
                       return random.calcNormal(static_cast<std::uint64_t>(i), kStart, stream);
                     });
  }

  static constexpr std::uint64_t kNormal = 0, kUniform = 1, kStart = 2, kMaxChains = 1000;
};

/// What is followed along a chain: the means of all targets at some samples, then the density. A row a
/// quantity, a column a draw.
MatrixXd follow(const markov::Chain& chain, network::WeightDensity& density, const MatrixXd& inputs) {
  MatrixXd followed(0, chain.draws.cols());
  VectorXd gradient;
  for (Index j = 0; j < chain.draws.cols(); ++j) {
    const network::Predictor predictor(density.unpack(chain.draws.col(j)));
    network::Predictor::Workspace workspace(predictor);
    const Index p = workspace.mean.size();
    followed.conservativeResize(p * inputs.cols() + 1, Eigen::NoChange);
    for (Index i = 0; i < inputs.cols(); ++i) {
      predictor.predict(inputs.col(i), workspace);
      followed.col(j).segment(i * p, p) = workspace.mean;
    }
    followed(p * inputs.cols(), j) = density.calculate(chain.draws.col(j), gradient);
  }
  return followed;
}

struct FollowedChain {
  markov::Chain chain;
  MatrixXd followed;
};

std::vector<FollowedChain> runChains(const network::Network& trained, const network::Samples& samples,
                                     const NetworkMapSpec& spec, const ChainSeed& seed,
                                     const TrainingControl& control) {
  constexpr Index kFollowed = 20;
  const MatrixXd followed = samples.inputs.leftCols(std::min(kFollowed, samples.inputs.cols()));
  std::vector<FollowedChain> chains(static_cast<std::size_t>(spec.chains));
  runTasks(control.threads, chains.size(), [&](std::size_t i) {
    const ChainStream stream(seed, i);
    network::WeightDensity density(trained, samples.inputs, samples.targets);
    markov::NutsOptions options;
    options.warm_up = options.draws = spec.draws;
    options.deepest = 8;  // of 10, four times as costly, chains were no better known: they seldom turn back
    options.stop = control.stop;
    const auto calculate = [&](const VectorXd& z, VectorXd& gradient) {
      return density.calculate(z, gradient);
    };
    chains[i].chain =
        markov::sampleNuts(calculate, stream.drawStart(density.pack(trained)), stream.makeNumbers(), options);
    chains[i].followed = follow(chains[i].chain, density, followed);
  });
  return chains;
}

markov::Convergence judge(const std::vector<FollowedChain>& chains, Index quantity) {
  std::vector<VectorXd> rows;
  for (const FollowedChain& chain : chains) {
    rows.emplace_back(chain.followed.row(quantity));
  }
  return markov::calcConvergence(rows);
}

WeightChains summarize(const std::vector<FollowedChain>& chains, Index targets) {
  const markov::Chain& first = chains.front().chain;
  WeightChains summary;
  summary.chains = static_cast<int>(chains.size());
  summary.draws = static_cast<int>(first.draws.cols());
  summary.weights = first.draws.rows();
  for (const FollowedChain& one : chains) {
    summary.divergences += one.chain.divergences;
    summary.cut += one.chain.cut;
    summary.mean_acceptance += one.chain.mean_acceptance / summary.chains;
  }
  const Index density = chains.front().followed.rows() - 1;
  summary.log_density = judge(chains, density);
  for (Index target = 0; target < targets; ++target) {
    markov::Convergence worst = judge(chains, target);
    for (Index quantity = target + targets; quantity < density; quantity += targets) {
      const markov::Convergence found = judge(chains, quantity);
      worst.r_hat = std::max(worst.r_hat, found.r_hat);
      worst.effective_sample_size = std::min(worst.effective_sample_size, found.effective_sample_size);
    }
    summary.means.push_back(worst);
  }
  return summary;
}

}  // namespace

SampledWeights sampleWeights(const network::Network& trained, const network::Samples& samples,
                             const NetworkMapSpec& spec, const ChainSeed& seed,
                             const TrainingControl& control) {
  constexpr Index kMax = 100;
  const std::vector<FollowedChain> chains = runChains(trained, samples, spec, seed, control);
  SampledWeights sampled{{}, summarize(chains, samples.targets.rows())};
  const network::WeightDensity density(trained, samples.inputs, samples.targets);
  const Index draws = chains.front().chain.draws.cols();
  const Index of_each = std::clamp<Index>(kMax / static_cast<Index>(chains.size()), 1, draws);
  for (const FollowedChain& one : chains) {
    for (Index i = 1; i <= of_each; ++i) {
      sampled.networks.push_back(density.unpack(one.chain.draws.col(i * draws / of_each - 1)));
    }
  }
  return sampled;
}

}  // namespace twinmap
