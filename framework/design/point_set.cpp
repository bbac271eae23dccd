#include "framework/design/point_set.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numeric>

namespace twinmap {
namespace {

using Eigen::MatrixXd;

/// Ranks of n random numbers: a random permutation of 0 .. n - 1.
std::vector<int> samplePermutation(int n, const RandomStream& random, int channel) {
  std::vector<double> keys(n);
  for (int i = 0; i < n; ++i) {
    keys[i] = random.calcUniform(i, channel);
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  std::vector<int> rank(n);
  for (int i = 0; i < n; ++i) {
    rank[order[i]] = i;
  }
  return rank;
}

MatrixXd sampleLatinHypercube(int dimensions, int n, const RandomStream& random) {
  MatrixXd points(dimensions, n);
  for (int d = 0; d < dimensions; ++d) {
    const std::vector<int> slice = samplePermutation(n, random, 2 * d);
    for (int i = 0; i < n; ++i) {
      points(d, i) = (slice[i] + random.calcUniform(i, 2 * d + 1)) / n;
    }
  }
  return points;
}

MatrixXd sampleSobol(int dimensions, int n, const RandomStream& random) {
  boost::random::sobol sequence(dimensions);
  const double scale = 1.0 / (static_cast<double>(boost::random::sobol::max()) + 1.0);
  MatrixXd points(dimensions, n);
  for (int i = 0; i < n; ++i) {
    for (int d = 0; d < dimensions; ++d) {
      const double shifted = static_cast<double>(sequence()) * scale + random.calcUniform(0, d);
      points(d, i) = shifted - std::floor(shifted);
    }
  }
  return points;
}

MatrixXd sampleUniform(int dimensions, int n, const RandomStream& random) {
  return MatrixXd::NullaryExpr(dimensions, n, [&](Eigen::Index d, Eigen::Index i) {
    return random.calcUniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(d));
  });
}

}  // namespace

MatrixXd sampleUnitCube(const PointSetSpec& spec, int dimensions, std::uint64_t seed, RandomPurpose purpose) {
  const RandomStream random(seed, purpose);
  switch (spec.method) {
    case DesignMethod::kLatinHypercube:
      return sampleLatinHypercube(dimensions, spec.samples, random);
    case DesignMethod::kSobol:
      return sampleSobol(dimensions, spec.samples, random);
    case DesignMethod::kUniform:
      break;
  }
  return sampleUniform(dimensions, spec.samples, random);
}

MatrixXd samplePoints(const PointSetSpec& spec, const std::vector<ParameterSpec>& parameters,
                      std::uint64_t seed, RandomPurpose purpose) {
  const int count = static_cast<int>(parameters.size());
  MatrixXd points = sampleUnitCube(spec, count, seed, purpose);
  for (int p = 0; p < count; ++p) {
    const Bounds& bounds = parameters[p].bounds;
    points.row(p).array() = bounds.lower + (bounds.upper - bounds.lower) * points.row(p).array();
  }
  return points;
}

}  // namespace twinmap
