#pragma once

#include <cstdint>
#include <vector>

#include "framework/estimation/run_tasks.hpp"
#include "framework/experiment/inverse_map_spec.hpp"
#include "kernels/network/train.hpp"
#include "kernels/sampling/convergence.hpp"

namespace twinmap {

/// How well chains know what they were sampled for.
struct WeightChains {
  std::vector<markov::Convergence> means;  ///< of each target: of the worst of its means at 20 samples
  markov::Convergence log_density;
  int chains = 0, draws = 0;  ///< of each chain
  int divergences = 0;        ///< trajectories whose energy ran away, of all draws
  int cut = 0;                ///< trajectories that did not turn back
  double mean_acceptance = 0.0;
  Eigen::Index weights = 0;  ///< numbers that are sampled
};

/// Networks whose weights are draws from their posterior.
struct SampledWeights {
  std::vector<network::Network> networks;  ///< at most 100 of the draws, evenly spaced
  WeightChains chains;
};

/// Which random numbers are taken.
struct ChainSeed {
  std::uint64_t seed = 0, run = 0;
};

/// No-U-Turn sampling of all weights of a network given samples (network::WeightDensity). Each chain begins
/// at the weights of `trained`, moved by a tenth of their prior's standard deviation. The result does not
/// depend on the threads. Throws gp::Stopped. Cost: up to 255 passes over all samples a draw.
SampledWeights sampleWeights(const network::Network& trained, const network::Samples& samples,
                             const NetworkMapSpec& spec, const ChainSeed& seed,
                             const TrainingControl& control);

}  // namespace twinmap
