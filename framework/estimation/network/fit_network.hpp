#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "framework/estimation/network/noisy_samples.hpp"
#include "framework/estimation/network/sample_weights.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/experiment/inverse_map_spec.hpp"
#include "kernels/network/ensemble.hpp"

namespace twinmap {

/// What a network is fitted to.
struct NetworkSet {
  const NoisySamples& samples;
  const Eigen::MatrixXd& targets;  ///< p x n, on [-1, 1]
};

/// Samples to learn from, and those that choose the checkpoint.
struct Split {
  std::vector<Eigen::Index> training, held_out;
};

/// How networks are fitted; `run` tells several of one experiment apart.
struct NetworkFitting {
  const NetworkMapSpec& spec;
  std::uint64_t seed = 0;
  std::uint64_t run = 0;
};

/// What a fit gives.
struct NetworkFit {
  std::vector<network::Member> members;
  int restarts = 0;                      ///< of the training (network::NetworkTraining)
  std::optional<WeightChains> chains{};  ///< of a Hamiltonian sampler
};

/// Trains a network on some of the samples, each step with other draws of their noise; the checkpoint is kept
/// that does best on the samples held out, of which several draws are taken once. With `bayesian: last_layer`
/// five, each with the exact posterior of its last layer given a draw of each training sample, at most 20000;
/// with `hamiltonian` draws of all weights (sampleWeights()), the chains of which begin at the trained one.
/// The result does not depend on the threads. Throws gp::Stopped. Cost: those of network::trainNetwork(), of
/// network::makeBayesian() and of sampleWeights().
NetworkFit fitNetwork(const NetworkSet& set, const Split& split, const NetworkFitting& fitting,
                      const TrainingControl& control);

/// Inputs (k x n draws) of samples with noise that no training sees; column j + i n is draw i of sample j.
Eigen::MatrixXd drawMeasured(const NoisySamples& samples, const std::vector<Eigen::Index>& chosen,
                             Eigen::Index draws, std::uint64_t seed);

}  // namespace twinmap
