#include "framework/tracking/track_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"
#include "kernels/sampling/weighted_draws.hpp"
#include "kernels/tracking/modes.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using tracking::Belief;

Belief toSpace(const VectorXd& mean, const MatrixXd& covariance, const TrackSpace& space) {
  Belief belief{VectorXd(space.count()), {}};
  VectorXd slopes(space.count());
  for (Index j = 0; j < space.count(); ++j) {
    belief.mean[j] = space.toCoordinate(j, mean[j]);
    slopes[j] = space.calcSlope(j, mean[j]);
  }
  belief.covariance = slopes.asDiagonal() * covariance * slopes.asDiagonal();
  return belief;
}

/// Normal distributions, and the share of each.
struct Parts {
  std::vector<Belief> beliefs;
  VectorXd weights;
};

Parts listParts(const Mixture& mixture, const TrackSpace& space) {
  Parts parts{{}, mixture.weights / mixture.weights.sum()};
  const Index p = space.count();
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    const VectorXd stddev = mixture.stddevs.col(c).head(p);
    const MatrixXd covariance = stddev.asDiagonal() *
                                mixture.correlations[static_cast<std::size_t>(c)].topLeftCorner(p, p) *
                                stddev.asDiagonal();
    parts.beliefs.push_back(toSpace(mixture.means.col(c).head(p), covariance, space));
  }
  return parts;
}

/// Draws in the coordinates (p x n), and mean and covariance of some of them.
MatrixXd toSpace(const BoundedDraws& draws, const TrackSpace& space) {
  MatrixXd points(space.count(), draws.points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    for (Index j = 0; j < points.rows(); ++j) {
      points(j, i) = space.toCoordinate(j, draws.points(j, i));
    }
  }
  return points;
}

Belief describe(const MatrixXd& points, const VectorXd& weights, const std::vector<Index>& chosen) {
  const VectorXd own = weights(chosen);
  const importance::WeightedDraws draws{points(Eigen::all, chosen), own / own.sum()};
  return {importance::calcMean(draws), importance::calcCovariance(draws)};
}

double calcAcross(const Belief& belief, const VectorXd& direction) {
  return belief.covariance.trace() - direction.dot(belief.covariance * direction);
}

/// Draws that bend, in slices across the direction in which they are widest; none where they do not. They
/// bend where slices are less than half as wide (variance) across it as all together: eight leave a
/// sixtyfourth of a parabola's.
Parts slice(const BoundedDraws& draws, const TrackSpace& space) {
  constexpr std::size_t kSlices = 8;
  constexpr double kBent = 0.5;
  const MatrixXd points = toSpace(draws, space);
  const Belief whole = describe(points, draws.weights, listIndices(points.cols()));
  const VectorXd direction = linalg::calcSymmetricEigen(whole.covariance).vectors.rightCols(1);
  const VectorXd along = points.transpose() * direction;
  Parts parts{{}, VectorXd::Constant(static_cast<Index>(kSlices), 1.0 / kSlices)};
  double across = 0.0;
  std::vector<Index> chosen;
  double share = 0.0;
  for (const Index i : sortIndices(along.size(), [&](Index a, Index b) { return along[a] < along[b]; })) {
    chosen.push_back(i);
    share += draws.weights[i];
    const double end = static_cast<double>(parts.beliefs.size() + 1) / kSlices;
    if (share >= end - 1e-9 && chosen.size() > static_cast<std::size_t>(points.rows())) {
      parts.beliefs.push_back(describe(points, draws.weights, chosen));
      across += calcAcross(parts.beliefs.back(), direction) / kSlices;
      chosen.clear();
    }
  }
  return parts.beliefs.size() == kSlices && across < kBent * calcAcross(whole, direction) ? parts : Parts{};
}

Parts listParts(const Estimate& estimate, const TrackSpace& space) {
  if (estimate.isMultimodal() && estimate.mixture.isGiven()) {
    return listParts(estimate.mixture, space);
  }
  if (estimate.ridge.isGiven()) {
    return listParts(estimate.ridge, space);
  }
  Parts parts;
  if (estimate.draws.isGiven()) {
    parts = slice(estimate.draws, space);
  }
  return parts.beliefs.empty()
             ? Parts{{toSpace(estimate.mean, estimate.calcCovariance(), space)}, VectorXd::Ones(1)}
             : parts;
}

/// Of a status, whether a measurement with it does not update: the model does not hold for it, or nothing
/// reliable is known of it.
bool isBarred(const std::string& status) {
  return status == "model_mismatch" || status == "model_incomplete" || status == "missing_term" ||
         status == "unreliable" || status == "not_simulated";
}

}  // namespace

bool informs(const Estimate& estimate, const std::vector<std::string>& use) {
  return estimate.isGiven() && estimate.mean.allFinite() && estimate.stddev.allFinite() &&
         std::none_of(estimate.statuses.begin(), estimate.statuses.end(), [&](const std::string& status) {
           return isBarred(status) && std::find(use.begin(), use.end(), status) == use.end();
         });
}

tracking::Measurement makeTrackMeasurement(const Estimate& estimate, const TrackSpace& space,
                                           const TrackPrior& prior) {
  const Parts parts = listParts(estimate, space);
  return makeLikelihood(prior.belief, parts.beliefs, parts.weights,
                        estimate.isRefined() ? std::vector<Index>{} : prior.uniform);
}

}  // namespace twinmap
