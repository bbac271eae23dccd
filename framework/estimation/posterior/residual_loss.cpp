#include "framework/estimation/posterior/residual_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/autocorrelation.hpp"
#include "kernels/linalg/autoregressive_whitener.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kOutlierShare = 0.01;  // of samples, before they are seen
constexpr double kOutlierScale = 10.0;  // in noise standard deviations
constexpr double kLeast = std::numeric_limits<double>::min();

/// Likelihoods of a residual, relative to that of noise at 0.
struct Likelihoods {
  double noise, outlier;
};

Likelihoods calcLikelihoods(double residual) {
  const double ratio = residual / kOutlierScale;
  const double peak = std::sqrt(2.0 / std::acos(-1.0)) / kOutlierScale;  // Cauchy's over the normal one's
  return {(1.0 - kOutlierShare) * std::exp(-0.5 * residual * residual),
          kOutlierShare * peak / (1.0 + ratio * ratio)};
}

/// The weight of a residual's square that gives the slope of its loss.
double calcOutlierWeight(double residual) {
  const Likelihoods likelihoods = calcLikelihoods(residual);
  const double is_noise = likelihoods.noise / (likelihoods.noise + likelihoods.outlier);
  return is_noise + (1.0 - is_noise) * 2.0 / (kOutlierScale * kOutlierScale + residual * residual);
}

/// n over the sum of squared autocorrelations: independent samples that would know a variance as well.
double countEffective(const VectorXd& autoregression, Index n) {
  if (autoregression.size() == 0) {
    return static_cast<double>(n);
  }
  const VectorXd rho =
      calcAutocorrelation(std::vector<double>(autoregression.begin(), autoregression.end()), n - 1);
  double sum = 1.0;
  for (Index k = 1; k < n; ++k) {
    sum += 2.0 * (1.0 - static_cast<double>(k) / static_cast<double>(n)) * rho[k] * rho[k];
  }
  return static_cast<double>(n) / sum;
}

/// The normal density over its distribution function, at z.
double calcMillsRatio(double z) {
  constexpr double kFar = -25.0;  // beyond, the distribution function is of tiny numbers
  if (z < kFar) {
    return -z * (1.0 + 1.0 / (z * z));  // its asymptotic series
  }
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::acos(-1.0));
  return density / (0.5 * std::erfc(-z / std::sqrt(2.0)));
}

/// -2 log of the normal distribution function.
double calcCensoredLoss(double z) {
  constexpr double kNear = -25.0;
  return z > kNear ? -2.0 * std::log(0.5 * std::erfc(-z / std::sqrt(2.0)))
                   : z * z + std::log(2.0 * std::acos(-1.0)) + 2.0 * std::log(calcMillsRatio(z));
}

}  // namespace

/// The loss of one output's samples.
class ResidualLoss::Output {
 public:
  Output(OutputNoise noise, OutputSamples samples, VectorXd offset)
      : noise_(std::move(noise)), samples_(std::move(samples)), offset_(std::move(offset)) {
    for (const NoiseColour& colour : noise_.colours) {
      whiteners_.emplace_back(colour.autoregression, samples_.lags);
    }
  }

  const std::vector<Index>& getRows() const { return samples_.rows; }

  double calc(const VectorXd& residual) const {
    return calcMixture(project(residual, MatrixXd(residual.size(), 0))).loss;
  }

  void addTo(const VectorXd& residual, const MatrixXd& jacobian, LinearLoss& sum) const {
    const std::vector<Projected> all = project(residual, jacobian);
    const VectorXd shares = calcMixture(all).shares;
    const Index u = jacobian.cols();
    for (std::size_t m = 0; m < all.size(); ++m) {
      const double precision = shares[static_cast<Index>(m)] * calcPrecision(all[m]);
      const auto derivatives = all[m].series.bottomRows(u);
      sum.information += precision * derivatives * derivatives.transpose();
      sum.descent += precision * derivatives * all[m].series.row(0).transpose();
      sum.chi_square += precision * all[m].squares;
    }
  }

  /// scale: of the squares, for the degrees of freedom that parameters take.
  FoundNoise standardize(VectorXd& residual, const MatrixXd& jacobian, double scale) const {
    const std::vector<Projected> all = project(residual, MatrixXd(residual.size(), 0));
    const VectorXd shares = calcMixture(all).shares;
    FoundNoise found;
    found.output = noise_.output;
    found.size_was_inferred = !noise_.factor;
    found.has_offset = noise_.has_offset;
    if (!whiteners_.empty()) {
      found.autoregression = VectorXd::Zero(noise_.colours.front().autoregression.size());
      for (std::size_t m = 0; m < all.size(); ++m) {
        found.autoregression += shares[static_cast<Index>(m)] * noise_.colours[m].autoregression;
      }
    }
    Projected at = makeProjected(residual, jacobian);
    if (found.autoregression.size() > 0) {
      whiten(AutoregressiveWhitener(found.autoregression, samples_.lags), at);
    }
    const MatrixXd whitened = at.series;
    projectOffset(at);
    const double variance =
        noise_.factor ? *noise_.factor * *noise_.factor : at.squares / (scale * at.degrees);
    VectorXd plain = residual(samples_.rows);
    if (noise_.has_offset) {
      found.offset = at.offset;
      found.offset_stddev = std::sqrt(variance / calcOffsetInformation(whitened, variance));
      plain -= at.offset * offset_;
    }
    residual(samples_.rows) = at.series.row(0).transpose() / std::sqrt(variance);
    found.factor = noise_.factor ? *noise_.factor : std::sqrt(plain.squaredNorm() / (scale * at.degrees));
    found.effective_samples = countEffective(found.autoregression, plain.size());
    return found;
  }

  double countTaken() const {
    return (noise_.has_offset ? 1.0 : 0.0) +
           (whiteners_.empty() ? 0.0 : static_cast<double>(noise_.colours.front().autoregression.size()));
  }

 private:
  /// What is left of it where the parameters are not known: Schur's complement, with their bounds.
  static double calcOffsetInformation(const MatrixXd& series, double variance) {
    const Index u = series.rows() - 2;
    const auto derivatives = series.bottomRows(u);
    const VectorXd shared = derivatives * series.row(1).transpose();
    const MatrixXd information =
        derivatives * derivatives.transpose() + kHalfWidthInformation * variance * MatrixXd::Identity(u, u);
    return series.row(1).squaredNorm() -
           linalg::solveLower(linalg::calcCholesky(information).lower, shared).squaredNorm();
  }

  /// Whitened residual (row 0), its derivatives and the offset (last row), the offset projected out.
  struct Projected {
    MatrixXd series;
    double squares = 0.0, degrees = 0.0, log_determinant = 0.0;
    double offset = 0.0, offset_information = 0.0;
  };

  Projected makeProjected(const VectorXd& residual, const MatrixXd& jacobian) const {
    const Index n = static_cast<Index>(samples_.rows.size()), u = jacobian.cols();
    Projected made;
    made.series.resize(u + 2, n);
    made.series.row(0) = residual(samples_.rows).transpose();
    made.series.row(1) = offset_.transpose();
    made.series.bottomRows(u) = jacobian(samples_.rows, Eigen::all).transpose();
    made.degrees = static_cast<double>(n);
    return made;
  }

  static void whiten(const AutoregressiveWhitener& whitener, Projected& projected) {
    whitener.apply(projected.series);
    projected.log_determinant = whitener.getLogDeterminant();
  }

  void projectOffset(Projected& projected) const {
    MatrixXd& series = projected.series;
    if (noise_.has_offset) {
      const Eigen::RowVectorXd own = series.row(1);
      projected.offset_information = own.squaredNorm();
      const VectorXd fitted = series * own.transpose() / projected.offset_information;
      projected.offset = fitted[0];
      series.row(0) -= fitted[0] * own;
      series.bottomRows(series.rows() - 2) -= fitted.tail(series.rows() - 2) * own;
      projected.log_determinant += std::log(projected.offset_information);
      projected.degrees -= 1.0;
    }
    projected.squares = std::max(series.row(0).squaredNorm(), kLeast);
  }

  std::vector<Projected> project(const VectorXd& residual, const MatrixXd& jacobian) const {
    const Projected plain = makeProjected(residual, jacobian);
    std::vector<Projected> all(std::max<std::size_t>(1, whiteners_.size()), plain);
    for (std::size_t m = 0; m < all.size(); ++m) {
      if (!whiteners_.empty()) {
        whiten(whiteners_[m], all[m]);
      }
      projectOffset(all[m]);
    }
    return all;
  }

  double calcPrecision(const Projected& one) const {
    return noise_.factor ? 1.0 / (*noise_.factor * *noise_.factor) : one.degrees / one.squares;
  }

  struct ColourMixture {
    double loss;      // -2 log of the likelihood
    VectorXd shares;  // of the colours in it
  };

  ColourMixture calcMixture(const std::vector<Projected>& all) const {
    VectorXd logs(static_cast<Index>(all.size()));
    for (std::size_t m = 0; m < all.size(); ++m) {
      const Projected& one = all[m];
      const double squares = noise_.factor ? one.squares * calcPrecision(one)
                                           : one.degrees * std::log(one.squares / one.degrees);
      logs[static_cast<Index>(m)] =
          -0.5 * (one.log_determinant + squares) + (whiteners_.empty() ? 0.0 : noise_.colours[m].log_weight);
    }
    const double largest = logs.maxCoeff();
    const VectorXd shares = (logs.array() - largest).exp();
    return {-2.0 * (largest + std::log(shares.sum())), shares / shares.sum()};
  }

  const OutputNoise noise_;
  const OutputSamples samples_;
  const VectorXd offset_;
  std::vector<AutoregressiveWhitener> whiteners_;
};

OutputSamples findSamples(const RefinementModel& model, const GrowingWindow& window, int output,
                          const std::vector<CensoredFeature>& censored) {
  constexpr double kSame = 1e-6;  // of the smallest difference, as grids are found
  const std::vector<FeatureInfo>& infos = model.getExtractor().getInfos();
  OutputSamples samples;
  for (std::size_t i = 0; i < window.features.size(); ++i) {
    const FeatureInfo& info = infos[static_cast<std::size_t>(window.features[i])];
    const bool is_censored = std::any_of(censored.begin(), censored.end(), [&](const CensoredFeature& one) {
      return one.feature == window.features[i];
    });
    if (info.output == output && info.time > 0.0 && !is_censored) {
      samples.rows.push_back(static_cast<Index>(i));
    }
  }
  const auto get_time = [&](Index row) {
    return infos[static_cast<std::size_t>(window.features[static_cast<std::size_t>(row)])].time;
  };
  std::stable_sort(samples.rows.begin(), samples.rows.end(),
                   [&](Index a, Index b) { return get_time(a) < get_time(b); });
  std::vector<double> times;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Index row : samples.rows) {
    if (!times.empty()) {
      smallest = std::min(smallest, get_time(row) - times.back());
    }
    times.push_back(get_time(row));
  }
  if (times.size() > 1 && smallest > kSame * times.back() / static_cast<double>(times.size())) {
    samples.lags = findLags(times, smallest);
  }
  return samples;
}

VectorXd makeOffset(const GrowingWindow& window, const OutputSamples& samples) {
  VectorXd constant = VectorXd::Zero(static_cast<Index>(window.features.size()));
  constant(samples.rows).setOnes();
  const VectorXd whitened = window.whitener->apply(constant).col(0);
  return whitened(samples.rows);
}

ResidualLoss::ResidualLoss(const NoiseHypothesis& hypothesis, const RefinementModel& model,
                           const GrowingWindow& window)
    : has_outliers_(hypothesis.has_outliers) {
  const auto size = static_cast<Index>(window.features.size());
  if (!window.whitener || window.whitener->getMatrix().rows() != size) {
    return;
  }
  scale_.setOnes(size);
  for (const OutputNoise& noise : hypothesis.outputs) {
    OutputSamples samples = findSamples(model, window, noise.output, hypothesis.censored);
    if (samples.rows.size() < 2) {
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
        std::make_shared<const Output>(std::move(possible), std::move(samples), std::move(offset)));
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
      const Likelihoods likelihoods = calcLikelihoods(one);
      loss -= 2.0 * std::log(likelihoods.noise + likelihoods.outlier);
    }
  } else {
    loss = scaled.squaredNorm();
  }
  for (const Censored& one : censored_) {
    loss += calcCensoredLoss(-one.side * one.scale * residual[one.row]);
  }
  for (const auto& output : outputs_) {
    loss += output->calc(residual);
  }
  return loss;
}

LinearLoss ResidualLoss::linearize(const VectorXd& residual, const MatrixXd& jacobian) const {
  const VectorXd scaled = scale(residual);
  LinearLoss linear;
  linear.weights =
      has_outliers_ ? VectorXd(scaled.unaryExpr(&calcOutlierWeight)) : VectorXd::Ones(residual.size());
  const VectorXd precisions = linear.weights.cwiseProduct(scale(VectorXd::Ones(residual.size())).cwiseAbs2());
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
  Standardized standardized{scale(residual), degrees, {}};
  const double scale = degrees / static_cast<double>(residual.size());
  for (const auto& output : outputs_) {
    VectorXd own = residual;
    standardized.noise.push_back(output->standardize(own, jacobian, scale));
    standardized.residual(output->getRows()) = own(output->getRows());
    standardized.degrees -= output->countTaken();
  }
  for (const Censored& one : censored_) {
    const double own = one.scale * residual[one.row];
    standardized.residual[one.row] = one.side * own > 0.0 ? own : std::numeric_limits<double>::quiet_NaN();
    standardized.degrees -= one.side * own > 0.0 ? 0.0 : 1.0;
  }
  standardized.degrees = std::max(standardized.degrees, 1.0);
  return standardized;
}

}  // namespace twinmap
