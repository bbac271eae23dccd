#include "framework/estimation/posterior/noise/residual_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "framework/estimation/posterior/noise/outlier_loss.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The normal distribution function; none where it is too small a number.
std::optional<double> calcNormalProbability(double z) {
  const double probability = 0.5 * std::erfc(-z / std::sqrt(2.0));
  return std::isnormal(probability) ? std::make_optional(probability) : std::nullopt;
}

/// The normal density over its distribution function, at z.
double calcMillsRatio(double z) {
  const std::optional<double> probability = calcNormalProbability(z);
  return probability ? std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::acos(-1.0)) / *probability
                     : -z * (1.0 + 1.0 / (z * z));  // its asymptotic series
}

/// -2 log of the normal distribution function.
double calcCensoredLoss(double z) {
  const std::optional<double> probability = calcNormalProbability(z);
  return probability ? -2.0 * std::log(*probability)
                     : z * z + std::log(2.0 * std::acos(-1.0)) + 2.0 * std::log(calcMillsRatio(z));
}

}  // namespace

ResidualLoss::ResidualLoss(const NoiseHypothesis& hypothesis, const RefinementModel& model,
                           const GrowingWindow& window)
    : has_outliers_(hypothesis.has_outliers) {
  const auto size = static_cast<Index>(window.features.size());
  if (!window.whitener || window.whitener->countDirections() != size) {
    return;
  }
  scale_.setOnes(size);
  for (const OutputNoise& noise : hypothesis.outputs) {
    OutputSamples samples = findSamples(model, window, noise.output, hypothesis.censored);
    if (samples.rows.size() < 2) {
      continue;
    }
    if (has_outliers_ && !noise.factor) {
      scale_(findSamples(model, window, noise.output).rows).setZero();
      of_unknown_size_.push_back({noise.output, std::move(samples.rows)});
      continue;
    }
    if (noise.factor && !noise.has_offset && noise.colours.empty()) {
      scale_(findSamples(model, window, noise.output).rows).setConstant(1.0 / *noise.factor);
      continue;
    }
    OutputNoise possible = noise;
    if (samples.lags.empty()) {
      possible.colours.clear();
    }
    scale_(findSamples(model, window, noise.output).rows).setZero();
    VectorXd offset = makeOffset(window, samples);
    outputs_.push_back(
        std::make_shared<const OutputLoss>(std::move(possible), std::move(samples), std::move(offset)));
  }
  for (const CensoredFeature& one : hypothesis.censored) {
    const auto found = std::lower_bound(window.features.begin(), window.features.end(), one.feature);
    if (found != window.features.end() && *found == one.feature) {
      const Index row = found - window.features.begin();
      censored_.push_back({row, one.side, scale_[row]});
      scale_[row] = 0.0;
    }
  }
}

VectorXd ResidualLoss::scale(const VectorXd& residual) const {
  return scale_.size() == residual.size() ? VectorXd(scale_.cwiseProduct(residual)) : residual;
}

double ResidualLoss::calc(const VectorXd& residual) const {
  if (!residual.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  const VectorXd scaled = scale(residual);
  double loss = 0.0;
  if (has_outliers_) {
    for (const double one : scaled) {
      loss += calcOutlierLoss(one);
    }
  } else {
    loss = scaled.squaredNorm();
  }
  for (const Censored& one : censored_) {
    loss += calcCensoredLoss(-one.side * one.scale * residual[one.row]);
  }
  for (const OfUnknownSize& output : of_unknown_size_) {
    loss += findOutlierSize(residual(output.rows)).loss;
  }
  for (const auto& output : outputs_) {
    loss += output->calc(residual);
  }
  return loss;
}

VectorXd ResidualLoss::scaleBySizes(const VectorXd& residual, VectorXd scaled) const {
  for (const OfUnknownSize& output : of_unknown_size_) {
    const VectorXd own = residual(output.rows);
    scaled(output.rows) = own / findOutlierSize(own).size;
  }
  return scaled;
}

LinearLoss ResidualLoss::linearize(const VectorXd& residual, const MatrixXd& jacobian) const {
  const VectorXd scaled = scaleBySizes(residual, scale(residual));
  LinearLoss linear;
  linear.weights =
      has_outliers_ ? VectorXd(scaled.unaryExpr(&calcOutlierWeight)) : VectorXd::Ones(residual.size());
  VectorXd scales = scale(VectorXd::Ones(residual.size()));
  for (const OfUnknownSize& output : of_unknown_size_) {
    scales(output.rows).setConstant(1.0 / findOutlierSize(residual(output.rows)).size);
  }
  const VectorXd precisions = linear.weights.cwiseProduct(scales.cwiseAbs2());
  const MatrixXd weighted = precisions.asDiagonal() * jacobian;
  linear.information = jacobian.transpose() * weighted;
  linear.descent = weighted.transpose() * residual;
  linear.chi_square = precisions.dot(residual.cwiseAbs2());
  linear.loss = calc(residual);
  for (const Censored& one : censored_) {
    const double z = -one.side * one.scale * residual[one.row], ratio = calcMillsRatio(z);
    const VectorXd derivatives = one.scale * jacobian.row(one.row).transpose();
    linear.information += ratio * (ratio + z) * derivatives * derivatives.transpose();
    linear.descent += one.side * ratio * derivatives;
    linear.chi_square += z < 0.0 ? z * z : 0.0;
  }
  for (const auto& output : outputs_) {
    output->addTo(residual, jacobian, linear);
  }
  return linear;
}

ResidualLoss::Standardized ResidualLoss::standardize(const VectorXd& residual, const MatrixXd& jacobian,
                                                     double degrees) const {
  Standardized standardized{scale(residual), jacobian, degrees, {}};
  if (scale_.size() == residual.size()) {
    standardized.jacobian = scale_.asDiagonal() * jacobian;
  }
  const double scale = degrees / static_cast<double>(residual.size());
  for (const OfUnknownSize& output : of_unknown_size_) {
    const VectorXd own = residual(output.rows);
    FoundNoise found;
    found.output = output.output;
    found.size_was_inferred = true;
    found.factor = findOutlierSize(own).size / std::sqrt(scale);
    found.effective_samples = static_cast<double>(own.size());
    standardized.residual(output.rows) = own / found.factor;
    standardized.jacobian(output.rows, Eigen::all) = jacobian(output.rows, Eigen::all) / found.factor;
    standardized.noise.push_back(std::move(found));
  }
  for (const auto& output : outputs_) {
    VectorXd own = residual;
    MatrixXd slopes = jacobian;
    standardized.noise.push_back(output->standardize(own, slopes, scale));
    standardized.residual(output->getRows()) = own(output->getRows());
    standardized.jacobian(output->getRows(), Eigen::all) = slopes(output->getRows(), Eigen::all);
    standardized.degrees -= output->countTaken();
  }
  for (const Censored& one : censored_) {
    const double own = one.scale * residual[one.row];
    standardized.residual[one.row] = one.side * own > 0.0 ? own : std::numeric_limits<double>::quiet_NaN();
    standardized.jacobian.row(one.row).setZero();
    standardized.degrees -= one.side * own > 0.0 ? 0.0 : 1.0;
  }
  standardized.degrees = std::max(standardized.degrees, 1.0);
  return standardized;
}

std::vector<ResidualLoss> makeLosses(const NoiseHypothesis& hypothesis, const RefinementModel& model) {
  std::vector<ResidualLoss> losses;
  if (!hypothesis.isPlain()) {
    for (const GrowingWindow& window : model.getWindows()) {
      losses.emplace_back(hypothesis, model, window);
    }
  }
  return losses;
}

}  // namespace twinmap
