#include "kernels/gp/starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "kernels/linalg/order.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// 8128 pairs: they tell the median to some per cent; bounds and starts need no more.
constexpr Index kMedianSamples = 128;

MatrixXd spacedSamples(const MatrixXd& inputs) {
  const Index count = std::min(kMedianSamples, inputs.cols());
  MatrixXd samples(inputs.rows(), count);
  for (Index i = 0; i < count; ++i) {
    samples.col(i) = inputs.col(i * inputs.cols() / count);
  }
  return samples;
}

// The median of the distances that are not zero; 0 if all are.
double medianNonzeroRoot(std::vector<double> squares) {
  squares.erase(std::remove(squares.begin(), squares.end(), 0.0), squares.end());
  return std::sqrt(calcMedian(std::move(squares)));
}

// Entry g: the squared distances of all pairs within group g; the last entry: over all features.
std::vector<std::vector<double>> calcPairDistances(const TrainingSet& set) {
  const MatrixXd samples = spacedSamples(set.getInputs());
  const auto& groups = set.getStructure().length_scale_groups;
  const int count = getGroupCount(set.getStructure());
  std::vector<std::vector<double>> squares(count + 1);
  VectorXd of_group(count);
  for (Index i = 0; i < samples.cols(); ++i) {
    for (Index j = 0; j < i; ++j) {
      of_group.setZero();
      for (Index f = 0; f < samples.rows(); ++f) {
        const double difference = samples(f, i) - samples(f, j);
        of_group(groups.empty() ? 0 : groups[f]) += difference * difference;
      }
      for (int g = 0; g < count; ++g) {
        squares[g].push_back(of_group(g));
      }
      squares[count].push_back(of_group.sum());
    }
  }
  return squares;
}

// Start number k: multiples of the median distance and of the target's stddev. Beyond the table, a
// low-discrepancy (golden ratio) sequence over the same ranges.
std::array<double, 2> spread(int k, const TrainingOptions& options) {
  // From short to long length scales with little to much noise; the second, which is used most, lies far off
  // the first in both.
  constexpr std::array<std::array<double, 2>, 4> kTable{{{1.0, 0.0}, {3.0, 0.03}, {0.5, 0.1}, {8.0, 0.5}}};
  if (k == 0) {
    return {options.start_length_scale, options.start_noise};
  }
  if (k < 4) {
    return kTable[k];
  }
  // The inverse powers of x^3 = x + 1's root, the golden ratio's like in two dimensions.
  const double u = std::fmod(0.7548776662466927 * k, 1.0);
  const double v = std::fmod(0.5698402909980532 * k, 1.0);
  return {0.3 * std::pow(10.0 / 0.3, u), 0.03 * std::pow(0.7 / 0.03, v)};
}

void setBounds(SearchBox& box, int index, double lower_scale, double upper_scale,
               const RelativeBounds& bounds) {
  box.lower(index) = std::log(lower_scale * bounds.lower);
  box.upper(index) = std::log(upper_scale * bounds.upper);
}

}  // namespace

DataScales calcDataScales(const TrainingSet& set) {
  auto squares = calcPairDistances(set);
  const int groups = getGroupCount(set.getStructure());
  DataScales scales;
  scales.median_distance = medianNonzeroRoot(squares.back());
  const MatrixXd centered = set.getInputs().colwise() - calcCenter(set.getInputs());
  scales.root_mean_square = std::sqrt(centered.squaredNorm() / static_cast<double>(set.size()));
  if (scales.median_distance == 0.0) {
    scales.median_distance = scales.root_mean_square;
  }
  const bool all_equal = (set.getInputs().colwise() - set.getInputs().col(0)).cwiseAbs().maxCoeff() == 0.0;
  if (all_equal || !(scales.median_distance > 0.0) || !std::isfinite(scales.median_distance)) {
    throw std::invalid_argument("train: the training inputs are all equal (or overflow when squared)");
  }
  scales.group_distances.resize(groups);
  for (int g = 0; g < groups; ++g) {
    const double own = std::sqrt(static_cast<double>(groups)) * medianNonzeroRoot(squares[g]);
    scales.group_distances(g) = own > 0.0 ? own : scales.median_distance;
  }
  return scales;
}

SearchBox makeSearchBox(const TrainingSet& set, const DataScales& scales, double target_stddev,
                        const TrainingOptions& options) {
  const HyperparameterLayout layout(set.getStructure());
  SearchBox box{VectorXd(layout.count), VectorXd(layout.count), VectorXd::Zero(layout.count),
                VectorXd::Zero(layout.count)};
  for (int g = 0; g < layout.signal; ++g) {
    const double own = scales.group_distances(g);
    setBounds(box, g, std::min(own, scales.median_distance), std::max(own, scales.median_distance),
              options.length_scale);
    if (!options.length_scale_prior) {
      continue;
    }
    box.prior_mean(g) = std::log(own) + options.length_scale_prior->log_mean;
    box.prior_precision(g) = std::pow(options.length_scale_prior->log_stddev, -2);
  }
  setBounds(box, layout.signal, target_stddev, target_stddev, options.signal_stddev);
  setBounds(box, layout.noise, target_stddev, target_stddev, options.noise_stddev);
  if (layout.shape >= 0) {
    setBounds(box, layout.shape, 1.0, 1.0, options.shape);
  }
  const double slope = target_stddev / scales.root_mean_square;
  if (layout.linear >= 0) {
    setBounds(box, layout.linear, slope, slope, options.linear_stddev);
  }
  return box;
}

std::vector<VectorXd> makeStarts(const TrainingSet& set, const DataScales& scales, double target_stddev,
                                 const TrainingOptions& options, int count) {
  std::vector<VectorXd> starts;
  for (int k = 0; k < count; ++k) {
    const auto [length_factor, noise_factor] = spread(k, options);
    Hyperparameters start;
    start.length_scales = length_factor * scales.group_distances;
    start.signal_stddev = target_stddev;
    start.noise_stddev = noise_factor * target_stddev;
    constexpr double kLinearPart = 0.5;  // of the stddev: a quarter of the variance
    start.linear_stddev = kLinearPart * target_stddev / scales.root_mean_square;
    starts.push_back(toLog(set.getStructure(), start));
  }
  return starts;
}

double calcNoiseOnlyNlml(const TrainingSet& set, const VectorXd& target) {
  const MatrixXd& basis = set.meanBasis();
  const Index p = basis.cols();
  const double free_samples = static_cast<double>(set.size() - p);
  double residual = target.squaredNorm();
  double log_determinant = 0.0;
  if (p > 0) {
    MatrixXd normal(p, p);
    linalg::TriangularScratch scratch(p);
    const linalg::ConstView h = linalg::viewOf(basis);
    linalg::gemm(1.0, h.transposed(), h, 0.0, linalg::viewOf(normal), scratch.gemm());
    if (!linalg::factorizeCholesky(linalg::viewOf(normal), scratch)) {
      throw std::invalid_argument(
          "train: a linear mean needs linearly independent features; some are constant or combinations");
    }
    VectorXd projected(p);
    for (Index k = 0; k < p; ++k) {
      projected(k) = basis.col(k).dot(target);
    }
    linalg::solveLower(linalg::viewOf(normal), projected.data());
    residual -= projected.squaredNorm();
    for (Index k = 0; k < p; ++k) {
      log_determinant += std::log(normal(k, k));
    }
  }
  constexpr double kRounding = 1e-28;  // (1e-14)^2: a target that the mean explains leaves no less
  residual = std::max(residual, kRounding * target.squaredNorm());
  return 0.5 * free_samples * (std::log(residual / free_samples) + 1.0 + kLogTwoPi) + log_determinant;
}

bool isNoiseOnly(double nlml, double noise_only_nlml) {
  constexpr double kMargin = 5.0;  // nats: chance gains two or four, a signal of the order of n
  return !(nlml < noise_only_nlml - kMargin);
}

}  // namespace twinmap::gp
