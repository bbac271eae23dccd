#pragma once

#include <Eigen/Core>

#include "framework/base/random/random.hpp"

namespace twinmap {

/// The first n points (dimensions x n) of a sequence in the unit cube that is a Latin hypercube at the sizes
/// L = smallest * 2^k, k = 0, 1, 2 ...: a longer set begins with the shorter one, whatever the sizes. Built
/// by doubling (Sallaberry, Helton, Hora 2008; a nested Latin hypercube in the sense of Qian 2009): a point
/// of the next level goes into the half of a slice that its present point leaves empty.
///
/// In each dimension, of any n points each of the L slices holds floor(n / L) or ceil(n / L), for every such
/// L: between the levels, too, no slice is forgotten. How the dimensions are paired is random, as in a plain
/// Latin hypercube. O(dimensions n log^2 n).
///
/// `smallest` times a power of two must reach n within an int.
Eigen::MatrixXd sampleNestedLatinHypercube(int dimensions, int n, int smallest, const RandomStream& random);

}  // namespace twinmap
