#include "framework/estimation/trained/anomaly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinmap {

using Eigen::Index;

namespace {

/// The standard normal deviate as unlikely as a chi square with `degrees` degrees of freedom.
double calcDeviate(double chi_square, Index degrees) {
  const double variance = 2.0 / (9.0 * static_cast<double>(degrees));
  return (std::cbrt(chi_square / static_cast<double>(degrees)) - (1.0 - variance)) / std::sqrt(variance);
}

}  // namespace

Anomaly findAnomaly(const Eigen::VectorXd& residual, const std::vector<ResidualRun>& runs) {
  Anomaly worst{-std::numeric_limits<double>::infinity(), 0, 0};
  for (const ResidualRun& run : runs) {
    for (Index count = 1; count <= run.count; count *= 2) {
      double most = -1.0;
      Index first = 0;
      for (Index i = run.first; i + count <= run.first + run.count; i += std::max<Index>(count / 2, 1)) {
        const double sum = residual.segment(i, count).squaredNorm();
        if (sum > most) {
          most = sum;
          first = i;
        }
      }
      const double score = calcDeviate(most, count);
      if (score > worst.score) {
        worst = {score, first, count};
      }
    }
  }
  return worst;
}

}  // namespace twinmap
