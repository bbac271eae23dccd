#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "framework/data/reduction/selections.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What each feature adds to those selected: its noise and sensitivities without the part that the selected
/// features' noise predicts, updated like the columns of a pivoted Cholesky factor.
class GreedySelection {
 public:
  GreedySelection(const NoiseCovariance& covariance, const std::vector<MatrixXd>& sensitivities,
                  const MatrixXd& prior, Index most)
      : covariance_(covariance), variance_(covariance.diagonal()), factor_(covariance.size(), most) {
    for (const MatrixXd& sensitivity : sensitivities) {
      const MatrixXd uniform = MatrixXd::Identity(sensitivity.cols(), sensitivity.cols());
      points_.push_back({sensitivity, prior.size() > 0 ? prior : kUniformInformation * uniform});
    }
  }

  const std::vector<Index>& getSelected() const { return selected_; }

  /// Increase of the sum of log det per feature: log(1 + g A^-1 g' / r). A feature adds the sensitivities g
  /// and the noise variance r to information A. One that adds no noise of its own has -infinity.
  VectorXd calcGains() const {
    constexpr double kOwnNoise = 1e-10;  // of a feature's variance
    VectorXd gains = VectorXd::Zero(variance_.size());
    for (const Point& point : points_) {
      const MatrixXd solved =
          linalg::solveLower(linalg::calcCholesky(point.information).lower, point.sensitivities.transpose());
      gains.array() += (solved.colwise().squaredNorm().transpose().array() / variance_.array()).log1p();
    }
    const auto own = variance_.array() > kOwnNoise * covariance_.diagonal().array();
    return own.select(gains, -std::numeric_limits<double>::infinity());
  }

  void add(Index feature) {
    const auto k = static_cast<Index>(selected_.size());
    const double stddev = std::sqrt(variance_[feature]);
    factor_.col(k) =
        (covariance_.col(feature) - factor_.leftCols(k) * factor_.row(feature).head(k).transpose()) / stddev;
    for (Point& point : points_) {
      const Eigen::RowVectorXd whitened = point.sensitivities.row(feature) / stddev;
      point.information += whitened.transpose() * whitened;
      point.sensitivities -= factor_.col(k) * whitened;
    }
    variance_ -= factor_.col(k).cwiseAbs2();
    variance_[feature] = 0.0;
    selected_.push_back(feature);
  }

 private:
  struct Point {
    MatrixXd sensitivities, information;
  };

  const NoiseCovariance& covariance_;
  VectorXd variance_;
  MatrixXd factor_;
  std::vector<Point> points_;
  std::vector<Index> selected_;
};

}  // namespace

std::vector<Index> selectByFisherInformation(const FisherInformationSpec& spec,
                                             const NoiseCovariance& noise_covariance,
                                             const std::vector<MatrixXd>& sensitivities,
                                             const MatrixXd& prior) {
  if (sensitivities.empty() || !(noise_covariance.diagonal().minCoeff() > 0.0)) {
    throw std::invalid_argument(
        "select by fisher_information needs sensitivities, and noise on every feature");
  }
  GreedySelection selection(noise_covariance, sensitivities, prior, spec.count);
  for (int k = 0; k < spec.count; ++k) {
    Index best = 0;
    if (!std::isfinite(selection.calcGains().maxCoeff(&best))) {
      throw std::invalid_argument(fmt::format(
          "select by fisher_information: asked for {} features, but only {} have noise of their own",
          spec.count, k));
    }
    selection.add(best);
  }
  return selection.getSelected();
}

}  // namespace twinmap
