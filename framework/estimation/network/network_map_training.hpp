#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/network/fit_network.hpp"
#include "framework/estimation/network/network_map.hpp"

namespace twinmap {

/// A trained network and what a person should know about it.
struct NetworkMapTraining {
  NetworkMap map;
  Estimates held_out;              ///< p x n draws, of samples that the network predicting them had not seen
  Eigen::MatrixXd held_out_truth;  ///< p x n draws
  int held_out_draws = 1;          ///< column j + i n is draw i of sample j
  std::optional<WeightChains> chains{};  ///< where weights were sampled
  std::vector<std::string> warnings;
};

}  // namespace twinmap
