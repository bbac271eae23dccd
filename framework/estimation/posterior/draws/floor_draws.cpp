#include "framework/estimation/posterior/draws/floor_draws.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The normal distribution at a place, across the valley, in LogCoordinates.
struct Across {
  VectorXd center;
  MatrixXd factor;  ///< u x k: times k standard normal numbers
  double misfit;    ///< of the center
};

/// False where the place is not on the floor.
bool findAcross(const LocalSurface& place, Across& across) {
  constexpr double kQuarter = 16.0 * kHalfWidthInformation, kFarthest = 1.0;
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(place.information);
  const Index steep = (eigen.values.array() >= kQuarter).count();
  across.factor =
      eigen.vectors.rightCols(steep) * eigen.values.tail(steep).cwiseSqrt().cwiseInverse().asDiagonal();
  const VectorXd steps = across.factor.transpose() * place.descent;
  across.center = place.at + across.factor * steps;
  across.misfit = place.misfit - steps.squaredNorm();
  return steps.norm() <= kFarthest;
}

/// Sums of weights and of weighted values at each place.
struct PlaceMoments {
  double weight = 0.0, first = 0.0, second = 0.0;
};

std::vector<PlaceMoments> sumAtPlaces(const FloorDraws& draws, const VectorXd& values) {
  std::vector<PlaceMoments> moments(static_cast<std::size_t>(draws.places.back()) + 1);
  const double shift = draws.weights.dot(values);
  for (Index i = 0; i < values.size(); ++i) {
    PlaceMoments& one = moments[static_cast<std::size_t>(draws.places[static_cast<std::size_t>(i)])];
    const double value = values[i] - shift;
    one.weight += draws.weights[i];
    one.first += draws.weights[i] * value;
    one.second += draws.weights[i] * value * value;
  }
  return moments;
}

}  // namespace

bool FloorDraws::determine(const VectorXd& values) const {
  constexpr double kFewest = 3.0;  // as of points that show a ridge
  if (!isGiven() || !values.allFinite()) {
    return false;
  }
  double between = 0.0, all = 0.0, squares = 0.0;
  for (const PlaceMoments& one : sumAtPlaces(*this, values)) {
    between += one.weight > 0.0 ? one.first * one.first / one.weight : 0.0;
    all += one.second;
    squares += one.weight * one.weight;
  }
  return 1.0 >= kFewest * squares && 2.0 * between <= all;
}

FloorDraws drawAcrossValleys(const std::vector<LocalSurface>& places, const LogCoordinates& coordinates,
                             std::uint64_t seed) {
  constexpr std::size_t kDraws = 4000, kFewest = 40;  // standard deviations are known to some per cent
  const RandomStream random(seed, RandomPurpose::kPosteriorWalk);
  const std::size_t pairs = std::max(kFewest, kDraws / std::max<std::size_t>(places.size(), 1)) / 2;
  FloorDraws draws;
  std::vector<VectorXd> points;
  std::vector<double> weights;
  for (std::size_t k = 0; k < places.size(); ++k) {
    Across across;
    if (!findAcross(places[k], across)) {
      continue;
    }
    for (std::size_t i = 0; i < 2 * pairs; ++i) {  // in pairs, so that their mean is the center
      VectorXd normal(across.factor.cols());
      random.drawNormals(k, i / 2, normal.data(), static_cast<std::size_t>(normal.size()));
      const VectorXd at = across.center + (i % 2 == 0 ? 1.0 : -1.0) * across.factor * normal;
      if (at.cwiseAbs().maxCoeff() <= 1.0) {
        points.push_back(coordinates.toParameters(at));
        weights.push_back(coordinates.calcLogUniform(at) - coordinates.calcLogUniform(across.center) -
                          0.5 * (across.misfit - places.front().misfit));
        draws.places.push_back(static_cast<int>(k));
      }
    }
  }
  const auto count = static_cast<Index>(points.size());
  draws.points.resize(coordinates.getCount(), count);
  draws.weights.resize(count);
  for (Index i = 0; i < count; ++i) {
    draws.points.col(i) = points[static_cast<std::size_t>(i)];
    draws.weights[i] = std::exp(weights[static_cast<std::size_t>(i)]);
  }
  draws.weights /= draws.weights.sum();
  return draws;
}

}  // namespace twinmap
