#include "kernels/sampling/adaptive_importance.hpp"

#include <vector>

namespace twinmap::importance {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kMaxParetoShape = 0.7;

/// What the rounds have drawn so far.
struct Evaluated {
  MatrixXd points;         // u x n
  VectorXd log_densities;  // n
  std::vector<BoxMixture> proposals;
};

void addRound(const LogDensities& density, const BoxMixture& proposal, const RoundNumbers& numbers,
              Evaluated& evaluated) {
  const MatrixXd points = proposal.draw(numbers.picks, numbers.normals);
  const Index before = evaluated.points.cols();
  evaluated.points.conservativeResize(points.rows(), before + points.cols());
  evaluated.points.rightCols(points.cols()) = points;
  evaluated.log_densities.conservativeResize(before + points.cols());
  evaluated.log_densities.tail(points.cols()) = density(points);
  evaluated.proposals.push_back(proposal);
}

/// Of all draws, by the mixture of all proposals.
VectorXd calcLogWeights(const Evaluated& evaluated) {
  const auto rounds = static_cast<Index>(evaluated.proposals.size());
  MatrixXd proposed(evaluated.points.cols(), rounds);
  for (Index round = 0; round < rounds; ++round) {
    proposed.col(round) =
        evaluated.proposals[static_cast<std::size_t>(round)].calcLogDensities(evaluated.points);
  }
  const VectorXd equal = VectorXd::Constant(rounds, 1.0 / static_cast<double>(rounds));
  return evaluated.log_densities - mixLogDensities(proposed, equal);
}

AdaptiveDraws summarize(const Evaluated& evaluated, const VectorXd& log_weights) {
  AdaptiveDraws weighted;
  weighted.draws = weigh(evaluated.points, log_weights);
  weighted.effective_sample_size = calcEffectiveSampleSize(weighted.draws);
  weighted.pareto_shape = calcParetoShape(weighted.draws);
  weighted.rounds = static_cast<int>(evaluated.proposals.size());
  return weighted;
}

}  // namespace

std::string AdaptiveDraws::findObstacle() const {
  if (!(effective_sample_size >= kSmallestSampleSize)) {
    return "the effective sample size stayed below 100";
  }
  if (!(pareto_shape <= kMaxParetoShape)) {
    return "the weights have too heavy a tail (Pareto shape above 0.7)";
  }
  return "";
}

AdaptiveDraws sampleAdaptively(const LogDensities& density, const BoxMixture& first,
                               const RoundSource& numbers, const AdaptiveOptions& options) {
  constexpr double kMinDraws = 10.0;  // a dimension that a covariance needs
  Evaluated evaluated;
  addRound(density, first, numbers(0), evaluated);
  VectorXd log_weights = calcLogWeights(evaluated);
  AdaptiveDraws weighted = summarize(evaluated, log_weights);
  const auto needs_more = [&] {
    const auto draws = static_cast<double>(numbers(0).picks.size());
    return !(weighted.effective_sample_size >= options.enough * draws) ||
           !(weighted.pareto_shape <= options.good_pareto_shape);
  };
  for (int round = 1; round < options.max_rounds && needs_more(); ++round) {
    const RoundNumbers& next = numbers(round);
    const WeightedDraws spread =
        temper(evaluated.points, log_weights, kMinDraws * static_cast<double>(evaluated.points.rows()));
    addRound(density, coverDraws(spread, next.centers, options.local), next, evaluated);
    log_weights = calcLogWeights(evaluated);
    weighted = summarize(evaluated, log_weights);
  }
  return weighted;
}

}  // namespace twinmap::importance
