#include "framework/data/reduction/mutual_information.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The smallest distances so far, ascending.
class Nearest {
 public:
  explicit Nearest(int count) : distances_(count, kInfinity) {}

  double getLargest() const { return distances_.back(); }

  void add(double distance) {
    if (distance < distances_.back()) {
      distances_.back() = distance;
      for (std::size_t i = distances_.size() - 1; i > 0 && distances_[i] < distances_[i - 1]; --i) {
        std::swap(distances_[i], distances_[i - 1]);
      }
    }
  }

 private:
  std::vector<double> distances_;
};

/// Distance of the sample at `place` in a's order to its nearest neighbours: outwards from it in that order,
/// until a alone differs by more.
double calcNeighbourDistance(const RankedValues& a, const RankedValues& b, Index place, int neighbours) {
  const auto count = static_cast<Index>(a.sorted.size());
  const double b_here = b.values[a.order[place]];
  Nearest nearest(neighbours);
  Index left = place - 1, right = place + 1;
  while (left >= 0 || right < count) {
    const double to_left = left >= 0 ? a.sorted[place] - a.sorted[left] : kInfinity;
    const double to_right = right < count ? a.sorted[right] - a.sorted[place] : kInfinity;
    const double difference = std::min(to_left, to_right);
    if (difference >= nearest.getLargest()) {
      break;
    }
    const Index other = a.order[to_left <= to_right ? left-- : right++];
    nearest.add(std::max(difference, std::abs(b.values[other] - b_here)));
  }
  return nearest.getLargest();
}

/// Other samples within `distance` of a value of the sample.
Index countWithin(const std::vector<double>& sorted, double value, double distance) {
  const auto first = std::partition_point(sorted.begin(), sorted.end(),
                                          [&](double other) { return value - other > distance; });
  const auto last =
      std::partition_point(first, sorted.end(), [&](double other) { return other - value <= distance; });
  return (last - first) - 1;
}

/// H(m) = 1 + 1/2 + ... + 1/m for m = 0 .. most: the digamma function at m + 1, plus Euler's constant.
VectorXd calcHarmonicNumbers(Index most) {
  VectorXd harmonic = VectorXd::Zero(most + 1);
  for (Index m = 1; m <= most; ++m) {
    harmonic[m] = harmonic[m - 1] + 1.0 / static_cast<double>(m);
  }
  return harmonic;
}

}  // namespace

RankedValues rankValues(const VectorXd& values) {
  constexpr double kRounding = 1e-14;
  const VectorXd centered = values.array() - values.mean();
  const double stddev = std::sqrt(centered.squaredNorm() / static_cast<double>(values.size()));
  if (!(stddev > kRounding * std::abs(values.mean()))) {
    return {};
  }
  RankedValues ranked{values / stddev, {}, sortIndices(values.size(), [&](Index i, Index j) {
                        return values[i] < values[j];
                      })};
  for (const Index i : ranked.order) {
    ranked.sorted.push_back(ranked.values[i]);
  }
  return ranked;
}

double calcMutualInformation(const RankedValues& a, const RankedValues& b, int neighbours) {
  if (a.values.size() == 0 || b.values.size() == 0) {
    return 0.0;
  }
  const Index count = a.values.size();
  const VectorXd harmonic = calcHarmonicNumbers(count);
  double sum = 0.0;
  for (Index place = 0; place < count; ++place) {
    const Index sample = a.order[place];
    const double below = std::nextafter(calcNeighbourDistance(a, b, place, neighbours), 0.0);
    sum += harmonic[countWithin(a.sorted, a.values[sample], below)] +
           harmonic[countWithin(b.sorted, b.values[sample], below)];
  }
  const double information =
      harmonic[count - 1] + harmonic[neighbours - 1] - sum / static_cast<double>(count);
  return std::max(0.0, information);
}

}  // namespace twinmap
