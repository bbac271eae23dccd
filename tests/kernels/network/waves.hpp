#pragma once

#include <cmath>

#include "kernels/network/density.hpp"

namespace twinmap::network {

/// The numbers that make_network_golden.py computes alike.
inline MatrixXd makeWave(Index rows, Index cols, double seed) {
  return MatrixXd::NullaryExpr(rows, cols, [seed](Index i, Index j) {
    const auto row = static_cast<double>(i), col = static_cast<double>(j);
    return std::sin(1.7 * row + 2.3 * col + 0.9 * row * col + seed);
  });
}

constexpr Index kTargets = 3, kInputs = 4, kSamples = 7;

/// The network of the golden case.
inline Network makeWaveNetwork(Index components = 1) {
  Network network{makeWave(kTargets, 1, 20),
                  makeWave(kTargets, kInputs, 21),
                  (0.5 + makeWave(kTargets, 1, 22).array().square()).matrix(),
                  {},
                  {}};
  const std::vector<Index> sizes{kInputs, 5, 6, countHeadOutputs(kTargets, components)};
  for (std::size_t k = 0; k + 1 < sizes.size(); ++k) {
    const auto seed = static_cast<double>(k);
    network.layers.push_back({makeWave(sizes[k + 1], sizes[k], seed), makeWave(sizes[k + 1], 1, 10 + seed)});
  }
  return network;
}

}  // namespace twinmap::network
