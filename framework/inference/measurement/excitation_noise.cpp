#include "framework/inference/measurement/excitation_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// In the directions of the eigenvectors of G G'.
struct RotatedFit {
  VectorXd eigenvalues, residual;
  MatrixXd jacobian;
};

struct Restricted {
  double loss = 0.0, chi_square = 0.0;
};

/// Not by Eigen's log of packets, of which the linker takes one copy for all. It may be this file's, which is
/// compiled light.
double sumLogs(const VectorXd& values) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [](double sum, double value) { return sum + std::log(value); });
}

Restricted calcRestricted(const RotatedFit& fit, double size) {
  const VectorXd precisions = (1.0 + size * size * fit.eigenvalues.array().max(0.0)).inverse();
  const MatrixXd weighted = precisions.asDiagonal() * fit.jacobian;
  const linalg::SymmetricEigen information = linalg::calcSymmetricEigen(fit.jacobian.transpose() * weighted);
  const double largest = information.values[information.values.size() - 1];
  // what nothing determines explains nothing
  const VectorXd values = information.values.cwiseMax(std::max(kRegular * largest, 1e-300));
  const VectorXd descent = information.vectors.transpose() * (weighted.transpose() * fit.residual);
  Restricted restricted;
  restricted.chi_square =
      precisions.dot(fit.residual.cwiseAbs2()) - descent.cwiseAbs2().cwiseQuotient(values).sum();
  restricted.loss = restricted.chi_square - sumLogs(precisions) + sumLogs(values);
  return restricted;
}

}  // namespace

std::optional<InputNoise> findInputNoise(const VectorXd& residual, const MatrixXd& jacobian,
                                         const MatrixXd& responses, double largest) {
  constexpr double kSmallest = 1e-3, kStep = 1.15;  // of the largest; a seventh of a size is no matter
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(responses * responses.transpose());
  if (!(eigen.values[eigen.values.size() - 1] > 0.0)) {
    return std::nullopt;
  }
  const RotatedFit fit{eigen.values, eigen.vectors.transpose() * residual,
                       eigen.vectors.transpose() * jacobian};
  const Restricted none = calcRestricted(fit, 0.0);
  InputNoise best{0.0, 0.0, none.chi_square};
  for (double size = kSmallest * largest; size <= largest; size *= kStep) {
    const Restricted one = calcRestricted(fit, size);
    if (none.loss - one.loss > best.gain) {
      best = {size, none.loss - one.loss, one.chi_square};
    }
  }
  return best;
}

void divideByFoundNoise(const LinearizedMeasurement& local, const FeatureExtractor& extractor,
                        const SimulatorFit& fit, Eigen::Ref<MatrixXd> rows) {
  for (const NoiseReport& report : fit.noise) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const auto feature = static_cast<std::size_t>(local.features[static_cast<std::size_t>(i)]);
      if (extractor.getInfos()[feature].output == report.found.output) {
        rows.row(i) /= report.found.factor;
      }
    }
  }
}

double findNoiseSize(LinearizedMeasurement local, const FeatureExtractor& extractor,
                     const Eigen::MatrixXd& responses, const SimulatorFit& fit) {
  constexpr double kLargest = 30.0;  // more is another signal
  const auto rows = static_cast<Eigen::Index>(local.features.size());
  if (responses.cols() == 0 || local.residual.size() != rows) {
    return 0.0;
  }
  Eigen::MatrixXd features = local.whitener->apply(extractor.extract(responses)(local.features, Eigen::all));
  divideByFoundNoise(local, extractor, fit, local.residual);
  divideByFoundNoise(local, extractor, fit, local.jacobian);
  divideByFoundNoise(local, extractor, fit, features);
  const std::optional<InputNoise> noise = findInputNoise(local.residual, local.jacobian, features, kLargest);
  const auto degrees = static_cast<double>(rows - local.jacobian.cols());
  return noise && noise->gain > kRareDeviations * kRareDeviations &&
                 noise->chi_square < degrees + kRareDeviations * std::sqrt(2.0 * degrees)
             ? noise->size
             : 0.0;
}

}  // namespace twinmap
