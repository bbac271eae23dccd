#include "framework/data/noise/feature_noise.hpp"

#include <algorithm>
#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kDraws = 2000;

/// All linear features of an extractor, one row each.
FeatureMatrix stackMatrices(const FeatureExtractor& extractor, Index response_rows, Index features) {
  std::vector<Eigen::Triplet<double>> entries;
  Index first = 0;
  for (const auto& block : extractor.getBlocks()) {
    if (const FeatureMatrix* matrix = block->findMatrix()) {
      for (Index row = 0; row < matrix->rows(); ++row) {
        for (FeatureMatrix::InnerIterator entry(*matrix, row); entry; ++entry) {
          entries.emplace_back(first + row, entry.col(), entry.value());
        }
      }
      first += matrix->rows();
    }
  }
  FeatureMatrix stacked(features, response_rows);
  stacked.setFromTriplets(entries.begin(), entries.end());
  return stacked;
}

MatrixXd takeFiniteColumns(const MatrixXd& values) {
  std::vector<Index> finite;
  for (Index j = 0; j < values.cols(); ++j) {
    if (values.col(j).allFinite()) {
      finite.push_back(j);
    }
  }
  return values(Eigen::all, finite);
}

}  // namespace

struct FeatureNoise::LinearForm {
  LinearForm(const FeatureExtractor& features, const ResponseNoise& response_noise, std::uint64_t seed,
             const VectorXd& stddevs)
      : extractor(features.makeLinearForm()), noise(extractor, response_noise, seed, stddevs) {}

  FeatureExtractor extractor;
  FeatureNoise noise;
};

FeatureNoise::FeatureNoise(const FeatureExtractor& extractor, const ResponseNoise& noise, std::uint64_t seed,
                           const VectorXd& stddevs)
    : extractor_(extractor) {
  Index feature = 0;
  for (const auto& block : extractor.getBlocks()) {
    for (std::size_t i = 0; i < block->getInfos().size(); ++i) {
      (block->findMatrix() != nullptr ? linear_ : nonlinear_).push_back(feature++);
    }
  }
  const Index rows = noise.getStddev().size();
  linear_covariance_ =
      noise.calcCovariance(stackMatrices(extractor, rows, static_cast<Index>(linear_.size())));
  if (extractor.hasLinearForm()) {
    linear_form_ = std::make_shared<const LinearForm>(extractor, noise, seed, stddevs);
  } else if (stddevs.size() > 0) {
    linear_covariance_ = linear_covariance_.replace(stddevs(linear_));
  }
  if (!nonlinear_.empty()) {
    draws_ = addNoise(MatrixXd::Zero(rows, kDraws), noise, {seed, RandomPurpose::kNoiseCovariance});
  }
}

const FeatureNoise& FeatureNoise::getLinearForm() const {
  return linear_form_ ? linear_form_->noise : *this;
}

NoiseCovariance FeatureNoise::calcCovariance(const VectorXd& response) const {
  return isConstant() ? linear_covariance_ : NoiseCovariance(calcSampledCovariance(response));
}

MatrixXd FeatureNoise::calcSampledCovariance(const VectorXd& response) const {
  const MatrixXd features = takeFiniteColumns(extractor_.extract(draws_.colwise() + response));
  const auto degrees = static_cast<double>(features.cols()) - 1.0 - static_cast<double>(linear_.size());
  if (degrees < 1.0) {
    throw std::runtime_error("noise leaves too few responses with all features to estimate its covariance");
  }
  const MatrixXd centered = features.colwise() - features.rowwise().mean().eval();
  const MatrixXd linear = centered(linear_, Eigen::all), others = centered(nonlinear_, Eigen::all);
  const MatrixXd slopes =
      linalg::solveSemidefinite(linear * linear.transpose(), linear * others.transpose()).transpose();
  const MatrixXd rest = others - slopes * linear;
  const MatrixXd cross = (linear_covariance_ * slopes.transpose()).transpose();  // C = C'

  MatrixXd covariance(features.rows(), features.rows());
  covariance(linear_, linear_) = linear_covariance_.toMatrix();
  covariance(nonlinear_, linear_) = cross;
  covariance(linear_, nonlinear_) = cross.transpose();
  covariance(nonlinear_, nonlinear_) = cross * slopes.transpose() + rest * rest.transpose() / degrees;
  return covariance;
}

NoiseCovariance FeatureNoise::calcMeanCovariance(const MatrixXd& responses) const {
  if (isConstant()) {
    return linear_covariance_;
  }
  constexpr Index kResponses = 32;
  const MatrixXd clean = takeFiniteColumns(responses);
  const Index count = std::min(clean.cols(), kResponses);
  MatrixXd sum = MatrixXd::Zero(extractor_.getFeatureCount(), extractor_.getFeatureCount());
  for (Index i = 0; i < count; ++i) {
    sum += calcSampledCovariance(clean.col(i));
  }
  return MatrixXd(sum / static_cast<double>(count));
}

}  // namespace twinmap
