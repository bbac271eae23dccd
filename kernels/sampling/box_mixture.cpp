#include "kernels/sampling/box_mixture.hpp"

#include <cassert>
#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::importance {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kReach = 0.5;  // standard deviations of all draws to those that are nearby
constexpr double kLogRootTwoPi = 0.91893853320467274;

/// Log densities (n) of one part.
VectorXd calcPartLogDensities(const NormalPart& part, const MatrixXd& points) {
  const MatrixXd standard = linalg::solveLower(part.lower, points.colwise() - part.mean);
  const double log_scale =
      part.lower.diagonal().array().log().sum() + kLogRootTwoPi * static_cast<double>(part.mean.size());
  return -0.5 * standard.colwise().squaredNorm().transpose().array() - log_scale;
}

/// Weighted draws near a point: a normal weight of half a standard deviation in the metric of `lower`.
WeightedDraws weighNearby(const WeightedDraws& draws, const VectorXd& center, const MatrixXd& lower) {
  const MatrixXd apart = linalg::solveLower(lower, draws.points.colwise() - center);
  const Eigen::ArrayXd log_weights =
      draws.weights.array().log() -
      apart.colwise().squaredNorm().transpose().array() / (2.0 * kReach * kReach);
  return weigh(draws.points, log_weights);
}

/// Cholesky factor of the draws' covariance; a floor keeps draws of one point apart, whatever their number.
MatrixXd factorise(const WeightedDraws& draws) {
  constexpr double kFloor = 1e-16;  // of half-widths squared
  const Index u = draws.points.rows();
  return linalg::calcCholesky(calcCovariance(draws) + kFloor * MatrixXd::Identity(u, u)).lower;
}

std::vector<NormalPart> fitNearby(const WeightedDraws& draws, const MatrixXd& centers,
                                  const MatrixXd& lower) {
  std::vector<NormalPart> parts;
  for (const auto& center : centers.colwise()) {
    parts.push_back({0.0, center, factorise(weighNearby(draws, center, lower))});
  }
  return parts;
}

/// Normal numbers to uniform ones on (-1, 1).
VectorXd spreadOverBox(const VectorXd& normals) {
  return normals.unaryExpr([](double z) { return std::erf(z * std::sqrt(0.5)); });
}

}  // namespace

BoxMixture::BoxMixture(std::vector<NormalPart> parts) : parts_(std::move(parts)) {
  for (const NormalPart& part : parts_) {
    assert(part.share > 0.0);
    uniform_share_ -= part.share;
  }
  assert(!parts_.empty() && uniform_share_ > 0.0);
}

MatrixXd BoxMixture::draw(const VectorXd& picks, const MatrixXd& normals) const {
  MatrixXd points(normals.rows(), normals.cols());
  for (Index i = 0; i < picks.size(); ++i) {
    double end = 0.0;
    std::size_t k = 0;
    while (k < parts_.size() && picks[i] >= end + parts_[k].share) {
      end += parts_[k++].share;
    }
    if (k < parts_.size()) {
      points.col(i).noalias() = parts_[k].lower * normals.col(i) + parts_[k].mean;
    } else {
      points.col(i) = spreadOverBox(normals.col(i));
    }
  }
  return points;
}

VectorXd BoxMixture::calcLogDensities(const MatrixXd& points) const {
  const auto count = static_cast<Index>(parts_.size());
  MatrixXd log_densities(points.cols(), count + 1);
  VectorXd shares(count + 1);
  for (Index k = 0; k < count; ++k) {
    const NormalPart& part = parts_[static_cast<std::size_t>(k)];
    log_densities.col(k) = calcPartLogDensities(part, points);
    shares[k] = part.share;
  }
  const double of_box = -std::log(2.0) * static_cast<double>(points.rows());
  for (Index i = 0; i < points.cols(); ++i) {
    log_densities(i, count) = points.col(i).cwiseAbs().maxCoeff() <= 1.0 ? of_box : -INFINITY;
  }
  shares[count] = uniform_share_;
  return mixLogDensities(log_densities, shares);
}

BoxMixture coverDraws(const WeightedDraws& draws, const VectorXd& uniforms, const LocalNormals& local) {
  constexpr double kWidening = 1.25, kMomentShare = 0.4, kUniformShare = 0.05;
  // wider parts beside those of the draws nearby, which have thinner ends than what they were drawn from
  constexpr double kWidths[] = {1.0, 2.0, 4.0}, kWidthShares[] = {0.7, 0.2, 0.1};
  const Index count = uniforms.size(), flat_count = count / 2;
  const MatrixXd lower = factorise(draws);
  const WeightedDraws flat = weigh(draws.points, 0.5 * draws.weights.array().log());
  MatrixXd centers(draws.points.rows(), count);
  centers << resample(draws, uniforms.head(count - flat_count)), resample(flat, uniforms.tail(flat_count));
  std::vector<NormalPart> parts{{kMomentShare, calcMean(draws), kWidening * lower}};
  const double share = (1.0 - kMomentShare - kUniformShare) / static_cast<double>(count);
  for (const NormalPart& own : local ? local(centers, kReach * lower) : fitNearby(draws, centers, lower)) {
    for (std::size_t k = 0; k < std::size(kWidths); ++k) {
      parts.push_back({kWidthShares[k] * share, own.mean, kWidths[k] * own.lower});
    }
  }
  return BoxMixture(std::move(parts));
}

VectorXd mixLogDensities(const MatrixXd& log_densities, const VectorXd& shares) {
  const VectorXd largest = log_densities.rowwise().maxCoeff();
  const MatrixXd relative = (log_densities.colwise() - largest).array().exp();
  return largest.array() + (relative * shares).array().log();
}

}  // namespace twinmap::importance
