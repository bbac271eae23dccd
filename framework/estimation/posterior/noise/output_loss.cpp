#include "framework/estimation/posterior/noise/output_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/autocorrelation.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

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

/// What is left of an offset's information (row 1) where the parameters of the derivatives (the rows below)
/// are not known: Schur's complement, with their bounds as a normal distribution.
double calcOffsetInformation(const MatrixXd& series, double variance) {
  const Index u = series.rows() - 2;
  const auto derivatives = series.bottomRows(u);
  const VectorXd shared = derivatives * series.row(1).transpose();
  const MatrixXd information =
      derivatives * derivatives.transpose() + kHalfWidthInformation * variance * MatrixXd::Identity(u, u);
  return series.row(1).squaredNorm() -
         linalg::solveLower(linalg::calcCholesky(information).lower, shared).squaredNorm();
}

/// The lags of stamps that are rounded, or jitter: each step in median steps, rounded, at least one.
std::vector<long> countSteps(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(times[i] - times[i - 1]);
  }
  const double median = calcMedian(steps);
  std::vector<long> lags{0};
  for (const double step : steps) {
    lags.push_back(lags.back() + (median > 0.0 ? std::max(1L, std::lround(step / median)) : 1L));
  }
  return lags;
}

}  // namespace

OutputSamples findSamples(const RefinementModel& model, const GrowingWindow& window, int output,
                          const std::vector<CensoredFeature>& censored) {
  const std::vector<FeatureInfo>& infos = model.getExtractor().getInfos();
  OutputSamples samples;
  for (std::size_t i = 0; i < window.features.size(); ++i) {
    const FeatureInfo& info = infos[static_cast<std::size_t>(window.features[i])];
    const bool is_censored = std::any_of(censored.begin(), censored.end(), [&](const CensoredFeature& one) {
      return one.feature == window.features[i];
    });
    if (info.output == output && info.isSample() && !is_censored) {
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
  if (times.size() > 1 && smallest > kSameNumber * times.back() / static_cast<double>(times.size())) {
    samples.lags = findLags(times, smallest);
  }
  if (samples.lags.empty() && times.size() > 2) {
    samples.lags = countSteps(times);
  }
  return samples;
}

VectorXd makeOffset(const GrowingWindow& window, const OutputSamples& samples) {
  VectorXd constant = VectorXd::Zero(static_cast<Index>(window.features.size()));
  constant(samples.rows).setOnes();
  const VectorXd whitened = window.whitener->apply(constant).col(0);
  return whitened(samples.rows);
}

OutputLoss::OutputLoss(OutputNoise noise, OutputSamples samples, VectorXd offset)
    : noise_(std::move(noise)), samples_(std::move(samples)), offset_(std::move(offset)) {
  for (const NoiseColour& colour : noise_.colours) {
    whiteners_.emplace_back(colour.autoregression, samples_.lags);
  }
}

double OutputLoss::calc(const VectorXd& residual) const {
  return calcMixture(project(residual, MatrixXd(residual.size(), 0))).loss;
}

void OutputLoss::addTo(const VectorXd& residual, const MatrixXd& jacobian, LinearLoss& sum) const {
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

FoundNoise OutputLoss::standardize(VectorXd& residual, MatrixXd& jacobian, double scale) const {
  FoundNoise found;
  found.output = noise_.output;
  found.size_was_inferred = !noise_.factor;
  found.has_offset = noise_.has_offset;
  found.autoregression =
      calcAutoregression(calcMixture(project(residual, MatrixXd(residual.size(), 0))).shares);
  Projected at = makeProjected(residual, jacobian);
  if (found.autoregression.size() > 0) {
    AutoregressiveWhitener(found.autoregression, samples_.lags).apply(at.series);
  }
  const MatrixXd whitened = at.series;
  projectOffset(at);
  const double variance = noise_.factor ? *noise_.factor * *noise_.factor : at.squares / (scale * at.degrees);
  VectorXd plain = residual(samples_.rows);
  if (noise_.has_offset) {
    found.offset = at.offset;
    found.offset_stddev = std::sqrt(variance / calcOffsetInformation(whitened, variance));
    plain -= at.offset * offset_;
  }
  residual(samples_.rows) = at.series.row(0).transpose() / std::sqrt(variance);
  jacobian(samples_.rows, Eigen::all) =
      at.series.bottomRows(jacobian.cols()).transpose() / std::sqrt(variance);
  found.factor = noise_.factor ? *noise_.factor : std::sqrt(plain.squaredNorm() / (scale * at.degrees));
  found.effective_samples = countEffective(found.autoregression, plain.size());
  return found;
}

double OutputLoss::countTaken() const {
  return (noise_.has_offset ? 1.0 : 0.0) +
         (whiteners_.empty() ? 0.0 : static_cast<double>(noise_.colours.front().autoregression.size()));
}

OutputLoss::Projected OutputLoss::makeProjected(const VectorXd& residual, const MatrixXd& jacobian) const {
  const Index n = static_cast<Index>(samples_.rows.size()), u = jacobian.cols();
  Projected made;
  made.series.resize(u + 2, n);
  made.series.row(0) = residual(samples_.rows).transpose();
  made.series.row(1) = offset_.transpose();
  made.series.bottomRows(u) = jacobian(samples_.rows, Eigen::all).transpose();
  made.degrees = static_cast<double>(n);
  return made;
}

void OutputLoss::projectOffset(Projected& projected) const {
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
  projected.squares = std::max(series.row(0).squaredNorm(), std::numeric_limits<double>::min());
}

std::vector<OutputLoss::Projected> OutputLoss::project(const VectorXd& residual,
                                                       const MatrixXd& jacobian) const {
  const Projected plain = makeProjected(residual, jacobian);
  std::vector<Projected> all(std::max<std::size_t>(1, whiteners_.size()), plain);
  for (std::size_t m = 0; m < all.size(); ++m) {
    if (!whiteners_.empty()) {
      whiteners_[m].apply(all[m].series);
      all[m].log_determinant = whiteners_[m].getLogDeterminant();
    }
    projectOffset(all[m]);
  }
  return all;
}

double OutputLoss::calcPrecision(const Projected& one) const {
  return noise_.factor ? 1.0 / (*noise_.factor * *noise_.factor) : one.degrees / one.squares;
}

OutputLoss::ColourMixture OutputLoss::calcMixture(const std::vector<Projected>& all) const {
  VectorXd logs(static_cast<Index>(all.size()));
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Projected& one = all[m];
    const double squares =
        noise_.factor ? one.squares * calcPrecision(one) : one.degrees * std::log(one.squares / one.degrees);
    logs[static_cast<Index>(m)] =
        -0.5 * (one.log_determinant + squares) + (whiteners_.empty() ? 0.0 : noise_.colours[m].log_weight);
  }
  const double largest = logs.maxCoeff();
  const VectorXd shares = (logs.array() - largest).exp();
  return {-2.0 * (largest + std::log(shares.sum())), shares / shares.sum()};
}

/// Their mean, as the shares are.
VectorXd OutputLoss::calcAutoregression(const VectorXd& shares) const {
  if (noise_.colours.empty()) {
    return {};
  }
  VectorXd mean = VectorXd::Zero(noise_.colours.front().autoregression.size());
  for (std::size_t m = 0; m < noise_.colours.size(); ++m) {
    mean += shares[static_cast<Index>(m)] * noise_.colours[m].autoregression;
  }
  return mean;
}

}  // namespace twinmap
