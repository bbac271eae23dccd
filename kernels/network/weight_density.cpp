#include "kernels/network/weight_density.hpp"

#include <cmath>
#include <utility>

namespace twinmap::network {
namespace {

constexpr double kPriorStddev = 2.0;

double calcWeightStddev(Index inputs) {
  return kPriorStddev / std::sqrt(static_cast<double>(inputs));
}

/// Calls part(values, prior's standard deviation) for each of the matrices and vectors of weights in
/// `layers`, then of the regression: the order of z.
template <typename Layers, typename Skip, typename Part>
void visitParts(Layers& layers, Skip& skip, const Part& part) {
  for (auto& layer : layers) {
    part(layer.weights.reshaped(), calcWeightStddev(layer.weights.cols()));
    part(layer.biases.reshaped(), kPriorStddev);
  }
  part(skip.reshaped(), calcWeightStddev(skip.cols()));
}

}  // namespace

WeightDensity::WeightDensity(Network reference, MatrixXd inputs, MatrixXd targets)
    : reference_(std::move(reference)),
      inputs_(std::move(inputs)),
      targets_(std::move(targets)),
      gradient_(makeZeros(reference_)) {}

Index WeightDensity::countWeights() const {
  Index count = 0;
  visitParts(gradient_.layers, gradient_.skip, [&](const auto& part, double) { count += part.size(); });
  return count;
}

VectorXd WeightDensity::pack(const Network& network) const {
  VectorXd z(countWeights());
  const MatrixXd change = reference_.scale.cwiseInverse().asDiagonal() * (network.skip - reference_.skip);
  Index first = 0;
  visitParts(network.layers, change, [&](const auto& part, double stddev) {
    z.segment(first, part.size()) = part / stddev;
    first += part.size();
  });
  return z;
}

Network WeightDensity::unpack(const Ref<const VectorXd>& z) const {
  Network network = reference_;
  MatrixXd change(network.skip.rows(), network.skip.cols());
  Index first = 0;
  visitParts(network.layers, change, [&](auto part, double stddev) {
    part = stddev * z.segment(first, part.size());
    first += part.size();
  });
  network.skip += network.scale.asDiagonal() * change;
  return network;
}

double WeightDensity::calculate(const VectorXd& z, VectorXd& gradient) {
  const double loss = calcLossAndGradient(unpack(z), inputs_, targets_, gradient_, pass_);
  gradient = -z;
  Index first = 0;
  visitParts(gradient_.layers, gradient_.skip, [&](const auto& part, double stddev) {
    gradient.segment(first, part.size()) -= stddev * part;
    first += part.size();
  });
  return -loss - 0.5 * z.squaredNorm();
}

}  // namespace twinmap::network
