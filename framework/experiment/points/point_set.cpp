#include "framework/experiment/points/point_set.hpp"

#include <boost/random/sobol.hpp>
#include <cmath>

#include "framework/base/random/nested_latin_hypercube.hpp"
#include "framework/base/random/slices.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

MatrixXd sampleLatinHypercube(int dimensions, int n, const RandomStream& random) {
  MatrixXd points(dimensions, n);
  for (int d = 0; d < dimensions; ++d) {
    const std::vector<int> slice = makePermutation(n, random, 2 * d);
    for (int i = 0; i < n; ++i) {
      points(d, i) = placeInSlice(slice[i], n, random.calcUniform(i, 2 * d + 1));
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
    case DesignMethod::kNestedLatinHypercube:
      return sampleNestedLatinHypercube(dimensions, spec.samples, spec.smallest.value_or(1), random);
    case DesignMethod::kSobol:
      return sampleSobol(dimensions, spec.samples, random);
    case DesignMethod::kUniform:
      break;
  }
  return sampleUniform(dimensions, spec.samples, random);
}

MatrixXd scaleToBounds(MatrixXd unit, const std::vector<ParameterSpec>& parameters) {
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Bounds& bounds = parameters[p].bounds;
    auto row = unit.row(static_cast<Eigen::Index>(p)).array();
    row = bounds.lower + (bounds.upper - bounds.lower) * row;
  }
  return unit;
}

MatrixXd samplePoints(const PointSetSpec& spec, const std::vector<ParameterSpec>& parameters,
                      std::uint64_t seed, RandomPurpose purpose) {
  return scaleToBounds(sampleUnitCube(spec, static_cast<int>(parameters.size()), seed, purpose), parameters);
}

}  // namespace twinmap
