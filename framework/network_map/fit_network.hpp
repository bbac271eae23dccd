#pragma once

#include <cstdint>
#include <vector>

#include "framework/inverse_map/training_control.hpp"
#include "framework/network_map/noisy_samples.hpp"
#include "framework/spec/inverse_map_spec.hpp"
#include "kernels/network/train.hpp"

namespace twinmap {

/// What a network is fitted to.
struct NetworkSet {
  const NoisySamples& samples;
  const Eigen::MatrixXd& targets;  ///< p x n, on [-1, 1]
};

/// How a network is fitted; `run` tells several of one experiment apart.
struct NetworkFitting {
  const NetworkMapSpec& spec;
  std::uint64_t seed = 0;
  std::uint64_t run = 0;
};

/// Trains a network on some of the samples, each step with other draws of their noise; the checkpoint is kept
/// that does best on the samples held out, of which several draws are taken once. The result does not depend
/// on the threads. Throws gp::Stopped. Cost: that of network::trainNetwork().
network::NetworkTraining fitNetwork(const NetworkSet& set, const std::vector<Eigen::Index>& training,
                                    const std::vector<Eigen::Index>& held_out, const NetworkFitting& fitting,
                                    const TrainingControl& control);

/// Inputs (k x n draws) of samples with noise that no training sees; column j + i n is draw i of sample j.
Eigen::MatrixXd drawMeasured(const NoisySamples& samples, const std::vector<Eigen::Index>& chosen,
                             Eigen::Index draws, std::uint64_t seed);

}  // namespace twinmap
