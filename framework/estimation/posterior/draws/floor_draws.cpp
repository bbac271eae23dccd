#include "framework/estimation/posterior/draws/floor_draws.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/estimation/box_points.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/ridges/flat_directions.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The normal distribution at a place, in LogCoordinates: across the valley, and along it with that of the
/// box.
struct LocalValley {
  VectorXd center;
  MatrixXd across, along;  ///< u x k: times k standard normal numbers
  double misfit;           ///< of the center
};

/// False where the place is not on the floor.
bool findValley(const LocalSurface& place, LocalValley& valley) {
  constexpr double kFarthest = 1.0;
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(place.information);
  const Index steep = (kMayBeFlat * kMayBeFlat * eigen.values.array() >= kHalfWidthInformation).count(),
              level = eigen.values.size() - steep;
  valley.across =
      eigen.vectors.rightCols(steep) * eigen.values.tail(steep).cwiseSqrt().cwiseInverse().asDiagonal();
  const VectorXd open = eigen.values.head(level).cwiseMax(0.0).array() + kHalfWidthInformation;
  valley.along = eigen.vectors.leftCols(level) * open.cwiseSqrt().cwiseInverse().asDiagonal();
  const VectorXd steps = valley.across.transpose() * place.descent;
  valley.center = place.at + valley.across * steps;
  valley.misfit = place.misfit - steps.squaredNorm();
  return steps.norm() <= kFarthest;
}

/// Gathers points with the logarithms of their weights.
class FloorBuilder {
 public:
  FloorBuilder(const LogCoordinates& coordinates, const RandomStream& random)
      : coordinates_(coordinates), random_(random) {}

  void addDraws(int place, const LocalValley& valley, double log_weight, std::size_t pairs) {
    const double uniform = coordinates_.calcLogUniform(valley.center);
    VectorXd normal(valley.across.cols());
    for (std::size_t i = 0; i < 2 * pairs; ++i) {  // in pairs, so that their mean is the center
      random_.drawNormals(static_cast<std::uint64_t>(place), i / 2, normal.data(),
                          static_cast<std::size_t>(normal.size()));
      const VectorXd at = valley.center + (i % 2 == 0 ? 1.0 : -1.0) * valley.across * normal;
      if (isInBox(at)) {
        add(place, at, std::exp(log_weight + coordinates_.calcLogUniform(at) - uniform), 0.0);
      }
    }
  }

  /// The place itself, then a step each way along the valley that leaves it open, short enough for any bend.
  void addSteps(int place, const VectorXd& at, const MatrixXd& along) {
    add(place, at, 0.0, 0.0);
    for (const auto& way : along.colwise()) {
      const double side = isInBox(at + kSameNumber * way) ? kSameNumber : -kSameNumber;
      add(place, clampToBox(at + side * way), 0.0, 1.0 / kSameNumber);
    }
  }

  FloorDraws take() const {
    FloorDraws draws{MatrixXd(coordinates_.getCount(), static_cast<Index>(points_.size())),
                     Eigen::Map<const VectorXd>(weights_.data(), static_cast<Index>(weights_.size())),
                     places_, Eigen::Map<const VectorXd>(scales_.data(), static_cast<Index>(scales_.size()))};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      draws.points.col(static_cast<Index>(i)) = points_[i];
    }
    draws.weights /= draws.weights.sum();
    return draws;
  }

 private:
  void add(int place, const VectorXd& at, double weight, double scale) {
    points_.push_back(coordinates_.toParameters(at));
    weights_.push_back(weight);
    places_.push_back(place);
    scales_.push_back(scale);
  }

  const LogCoordinates& coordinates_;
  const RandomStream& random_;
  std::vector<VectorXd> points_;
  std::vector<double> weights_, scales_;
  std::vector<int> places_;
};

/// Sums of weights and of weighted values at each place, and the variance that steps along the valley show.
struct PlaceMoments {
  double weight = 0.0, first = 0.0, second = 0.0, open = 0.0;
};

std::vector<PlaceMoments> sumAtPlaces(const FloorDraws& draws, const VectorXd& values) {
  std::vector<PlaceMoments> moments(static_cast<std::size_t>(draws.places.back()) + 1);
  const double mean = draws.weights.dot(values);
  double at_place = mean;
  for (Index i = 0; i < values.size(); ++i) {
    PlaceMoments& one = moments[static_cast<std::size_t>(draws.places[static_cast<std::size_t>(i)])];
    const double value = values[i] - mean;
    one.weight += draws.weights[i];
    one.first += draws.weights[i] * value;
    one.second += draws.weights[i] * value * value;
    at_place = draws.weights[i] == 0.0 && draws.scales[i] == 0.0 ? values[i] : at_place;
    const double slope = draws.scales[i] * (values[i] - at_place);
    one.open += slope * slope;
  }
  return moments;
}

}  // namespace

bool FloorDraws::determine(const VectorXd& values) const {
  if (!isGiven() || !values.allFinite()) {
    return false;
  }
  double between = 0.0, all = 0.0, open = 0.0, squares = 0.0;
  for (const PlaceMoments& one : sumAtPlaces(*this, values)) {
    between += one.weight > 0.0 ? one.first * one.first / one.weight : 0.0;
    all += one.second;
    open += one.weight * one.open;
    squares += one.weight * one.weight;
  }
  return 1.0 >= static_cast<double>(kMinRidgePoints) * squares && between <= kClearlyLess * all &&
         open <= kImmaterial * all;
}

FloorDraws drawAcrossValleys(const std::vector<LocalSurface>& places, const LogCoordinates& coordinates,
                             std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kPosteriorWalk);
  FloorBuilder builder(coordinates, random);
  const std::size_t pairs = kManyErrors / std::max<std::size_t>(places.size(), 1) + 1;
  for (std::size_t k = 0; k < places.size(); ++k) {
    LocalValley valley;
    if (findValley(places[k], valley)) {
      builder.addSteps(static_cast<int>(k), places[k].at, valley.along);
      builder.addDraws(static_cast<int>(k), valley, -0.5 * (valley.misfit - places.front().misfit), pairs);
    }
  }
  return builder.take();
}

}  // namespace twinmap
