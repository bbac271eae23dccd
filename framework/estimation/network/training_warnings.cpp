#include "framework/estimation/network/training_warnings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/log/notice.hpp"

namespace twinmap {

using Eigen::Index;

namespace {

/// Why answers are not of the kind that a network gives: of a few large errors among small ones, 50 % sets
/// hold more than that, and 95 % sets fewer.
std::string describeShape(double probability, double share, Index components) {
  const bool heavy_tails = (share > probability) == (probability < 0.9);
  if (components == 1) {
    return heavy_tails ? "normally distributed: a few errors are much larger than the others"
                       : "normally distributed: they are multimodal, or lie at the bounds";
  }
  return fmt::format("mixtures of {} normal distributions", components);
}

}  // namespace

void warnOfRestarts(int restarts, std::vector<std::string>& warnings) {
  if (restarts > 0) {
    warnings.push_back(describeNotice(Notice::kRestarts, restarts));
  }
}

void warnOfChains(const WeightChains& chains, std::vector<std::string>& warnings) {
  constexpr double kLargestRHat = 1.05, kMinDraws = 100.0, kMaxDivergences = 0.01;
  double r_hat = 0.0, draws = chains.log_density.effective_sample_size;
  for (const markov::Convergence& one : chains.means) {
    r_hat = std::max(r_hat, one.r_hat);
    draws = std::min(draws, one.effective_sample_size);
  }
  const double divergent = static_cast<double>(chains.divergences) / (chains.chains * chains.draws);
  if (r_hat > kLargestRHat || draws < kMinDraws || divergent > kMaxDivergences) {
    warnings.push_back(describeNotice(Notice::kChains, r_hat, draws, 100.0 * divergent));
  }
}

void warnOfShape(const std::vector<ParameterSpec>& parameters, NetworkMapTraining& training) {
  // A small difference is of no consequence, and twice the standard error is what so many simulations cannot
  // tell. Of a uniform distribution, a normal one's 50 % intervals hold 39 % and its 95 % intervals all; of
  // two answers apart the former next to none.
  struct Level {
    double probability, quantile, small;
  };
  constexpr Level kLevels[] = {{0.5, kNormal50, 0.04}, {0.95, kNormal95, 0.025}};
  const double simulations = static_cast<double>(training.held_out_truth.cols()) / training.held_out_draws;
  for (Index p = 0; p < training.held_out_truth.rows(); ++p) {
    const Eigen::ArrayXd depths = calcDepths(training.held_out, training.held_out_truth, p);
    for (const auto& [probability, quantile, small] : kLevels) {
      const double share = (depths < quantile).cast<double>().mean();
      if (std::abs(share - probability) > small + 2.0 * calcProportionError(probability, simulations)) {
        training.warnings.push_back(describeNotice(
            Notice::kShape, parameters[static_cast<std::size_t>(p)].name.text, 100.0 * probability,
            100.0 * share, describeShape(probability, share, training.map.countComponents()),
            2 * std::max<Index>(2, training.map.countComponents())));
        break;
      }
    }
  }
}

}  // namespace twinmap
