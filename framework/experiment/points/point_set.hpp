#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "framework/base/random/random.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Points in the unit cube, one column per point (dimensions x points), from the stream
/// (seed, purpose). Latin hypercube: each of the n equal slices of each dimension holds one point (McKay et
/// al. 1979); another size gives other points. Nested Latin hypercube: see nested_latin_hypercube.hpp; a
/// longer set begins with the shorter one. Sobol: the sequence rotated by one random shift per dimension
/// (Cranley-Patterson), so that a longer set begins with the shorter one. Uniform: independent. O(dimensions
/// n log n).
Eigen::MatrixXd sampleUnitCube(const PointSetSpec& spec, int dimensions, std::uint64_t seed,
                               RandomPurpose purpose);

/// Points of the unit cube scaled to the parameters' bounds (parameters x points).
Eigen::MatrixXd scaleToBounds(Eigen::MatrixXd unit, const std::vector<ParameterSpec>& parameters);

/// Both.
Eigen::MatrixXd samplePoints(const PointSetSpec& spec, const std::vector<ParameterSpec>& parameters,
                             std::uint64_t seed, RandomPurpose purpose);

}  // namespace twinmap
