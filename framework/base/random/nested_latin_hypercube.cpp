#include "framework/base/random/nested_latin_hypercube.hpp"

#include <vector>

#include "framework/base/random/slices.hpp"

namespace twinmap {
namespace {

/// Random numbers of one dimension; each request has a number of its own.
class Draws {
 public:
  Draws(const RandomStream& random, int dimension) : random_(random), channel_(dimension) {}

  std::vector<int> makePermutation(int n) {
    return twinmap::makePermutation(n, random_, channel_, next_request_++);
  }
  std::vector<double> makeUniforms(int n) {
    std::vector<double> values(n);
    for (int i = 0; i < n; ++i) {
      values[i] = random_.calcUniform(i, channel_, next_request_);
    }
    ++next_request_;
    return values;
  }

 private:
  const RandomStream& random_;
  std::uint64_t channel_;
  std::uint64_t next_request_ = 0;
};

/// All `size` = smallest * 2^k slices in a random order of which every beginning is balanced: any m of them
/// have floor(m / L) or ceil(m / L) in each of L = smallest * 2^j coarser slices. Either half of the order
/// takes one half of each of size / 2 slices, in such an order of its own.
std::vector<int> makeBalancedOrder(int size, int smallest, Draws& draws) {
  if (size == smallest) {
    return draws.makePermutation(size);
  }
  const int coarse = size / 2;
  const std::vector<int> first = makeBalancedOrder(coarse, smallest, draws);
  const std::vector<int> second = makeBalancedOrder(coarse, smallest, draws);
  const std::vector<double> coins = draws.makeUniforms(coarse);
  std::vector<int> order;
  order.reserve(size);
  for (const int slice : first) {
    order.push_back(2 * slice + (coins[slice] < 0.5 ? 0 : 1));
  }
  for (const int slice : second) {
    order.push_back(2 * slice + (coins[slice] < 0.5 ? 1 : 0));
  }
  return order;
}

void place(const std::vector<int>& slices, int slice_count, Draws& draws, std::vector<double>& points) {
  const std::vector<double> fractions = draws.makeUniforms(static_cast<int>(slices.size()));
  for (std::size_t i = 0; i < slices.size(); ++i) {
    points.push_back(placeInSlice(slices[i], slice_count, fractions[i]));
  }
}

/// Adds as many points as there are, one into each half slice that is empty.
void doublePoints(int smallest, Draws& draws, std::vector<double>& points) {
  const int size = static_cast<int>(points.size());
  std::vector<int> empty_half(size);
  for (const double x : points) {
    const int half = findSlice(x, 2 * size);
    empty_half[half / 2] = half ^ 1;
  }
  std::vector<int> slices = makeBalancedOrder(size, smallest, draws);
  for (int& slice : slices) {
    slice = empty_half[slice];
  }
  place(slices, 2 * size, draws, points);
}

}  // namespace

Eigen::MatrixXd sampleNestedLatinHypercube(int dimensions, int n, int smallest, const RandomStream& random) {
  Eigen::MatrixXd result(dimensions, n);
  for (int d = 0; d < dimensions; ++d) {
    Draws draws(random, d);
    std::vector<double> points;
    place(draws.makePermutation(smallest), smallest, draws, points);
    while (static_cast<int>(points.size()) < n) {
      doublePoints(smallest, draws, points);
    }
    result.row(d) = Eigen::Map<const Eigen::RowVectorXd>(points.data(), n);
  }
  return result;
}

}  // namespace twinmap
