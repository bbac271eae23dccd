#include "kernels/network/train.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/linalg/parallel.hpp"
#include "kernels/network/backpropagation.hpp"

namespace twinmap::network {
namespace {

constexpr Index kChunk = 64;  // large enough for full matrix products, small enough for four threads a batch
constexpr double kPi = 3.141592653589793;

Index countChunks(Index samples) {
  return (samples + kChunk - 1) / kChunk;
}

/// A part of a batch and what it gives.
struct Chunk {
  Samples samples;
  Gradient gradient;
  PassWorkspace workspace;
  double loss = 0.0;
};

void addTo(const Gradient& other, Gradient& sum) {
  sum.skip += other.skip;
  for (std::size_t i = 0; i < sum.layers.size(); ++i) {
    sum.layers[i].weights += other.layers[i].weights;
    sum.layers[i].biases += other.layers[i].biases;
  }
}

/// Divides by the number of samples; whether all is finite.
bool divide(double samples, Gradient& sum) {
  sum.skip /= samples;
  bool finite = sum.skip.allFinite();
  for (Layer& layer : sum.layers) {
    layer.weights /= samples;
    layer.biases /= samples;
    finite = finite && layer.weights.allFinite() && layer.biases.allFinite();
  }
  return finite;
}

/// The optimisers of all layers, and of the regression.
class Optimizers {
 public:
  Optimizers(const Network& network, const SoapOptions& options)
      : skip_(network.skip.rows(), network.skip.cols(), options) {
    for (const Layer& layer : network.layers) {
      weights_.emplace_back(layer.weights.rows(), layer.weights.cols(), options);
      biases_.emplace_back(layer.biases.size(), options);
    }
  }

  void step(const Gradient& gradient, double learning_rate, int threads, Network& network) {
    const auto layers = static_cast<Index>(network.layers.size());
    linalg::parallelFor(threads, layers + 1, 1, [&](Index index, int) {
      if (index == layers) {
        stepRegression(gradient.skip, learning_rate, network);
        return;
      }
      const auto i = static_cast<std::size_t>(index);
      weights_[i].step(gradient.layers[i].weights, learning_rate, network.layers[i].weights);
      biases_[i].step(gradient.layers[i].biases, learning_rate, network.layers[i].biases);
    });
  }

 private:
  void stepRegression(const MatrixXd& gradient, double learning_rate, Network& network) {
    MatrixXd change = MatrixXd::Zero(gradient.rows(), gradient.cols());
    skip_.step(gradient, learning_rate, change);
    network.skip += network.scale.asDiagonal() * change;
  }

  std::vector<SoapMatrix> weights_;
  std::vector<AdamVector> biases_;
  SoapMatrix skip_;
};

class Trainer {
 public:
  Trainer(Network initial, const BatchSource& source, const Samples& held_out, const TrainingOptions& options)
      : options_(options),
        source_(source),
        held_out_(held_out),
        network_(std::move(initial)),
        optimizers_(network_, options.soap),
        chunks_(static_cast<std::size_t>(countChunks(options.batch))) {
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
      const Index count = std::min(kChunk, options.batch - static_cast<Index>(i) * kChunk);
      chunks_[i].samples = {MatrixXd(network_.countInputs(), count),
                            MatrixXd(network_.countTargets(), count)};
      chunks_[i].gradient = makeZeros(network_);
    }
  }

  NetworkTraining run() {
    check();
    for (Index step = 0; step < options_.steps; ++step) {
      gp::throwIfStopped(options_.stop);
      if (!calcGradient(step)) {
        restart();
        continue;
      }
      optimizers_.step(chunks_.front().gradient, calcLearningRate(step), options_.threads, network_);
      if ((step + 1) % options_.check_interval == 0 || step + 1 == options_.steps) {
        check();
      }
    }
    return std::move(result_);
  }

 private:
  double calcLearningRate(Index step) const {
    const double at = (static_cast<double>(step) + 1.0) / static_cast<double>(options_.steps);
    const double warm = std::min(1.0, at / options_.warm_up);
    const double rest = std::max(0.0, (at - options_.warm_up) / (1.0 - options_.warm_up));
    return rate_ * options_.learning_rate * warm * 0.5 * (1.0 + std::cos(kPi * rest));
  }

  /// The mean gradient of a batch, in the first chunk; whether it is finite.
  bool calcGradient(Index step) {
    linalg::parallelFor(options_.threads, static_cast<Index>(chunks_.size()), 1, [&](Index index, int) {
      Chunk& chunk = chunks_[static_cast<std::size_t>(index)];
      source_(step, index * kChunk, chunk.samples);
      chunk.loss = calcLossAndGradient(network_, chunk.samples.inputs, chunk.samples.targets, chunk.gradient,
                                       chunk.workspace);
    });
    for (std::size_t i = 1; i < chunks_.size(); ++i) {
      addTo(chunks_[i].gradient, chunks_.front().gradient);
    }
    return divide(static_cast<double>(options_.batch), chunks_.front().gradient);
  }

  void check() {
    const double loss = calcMeanLoss(network_, held_out_, options_.threads);
    std::vector<double>& losses = result_.held_out_loss;
    losses.push_back(loss);
    if (losses.size() == 1 || loss < losses[static_cast<std::size_t>(result_.best_check)]) {
      result_.best_check = static_cast<Index>(losses.size()) - 1;
      result_.network = network_;
    }
  }

  void restart() {
    network_ = result_.network;
    optimizers_ = Optimizers(network_, options_.soap);
    rate_ *= 0.5;
    ++result_.restarts;
  }

  const TrainingOptions& options_;
  const BatchSource& source_;
  const Samples& held_out_;
  Network network_;
  Optimizers optimizers_;
  std::vector<Chunk> chunks_;
  double rate_ = 1.0;
  NetworkTraining result_;
};

}  // namespace

double calcMeanLoss(const Network& network, const Samples& samples, int threads) {
  const Index count = countChunks(samples.inputs.cols());
  VectorXd losses(count);
  linalg::parallelFor(threads, count, 1, [&](Index chunk, int) {
    const Index first = chunk * kChunk, size = std::min(kChunk, samples.inputs.cols() - first);
    PassWorkspace workspace;
    losses[chunk] = calcLoss(network, samples.inputs.middleCols(first, size),
                             samples.targets.middleCols(first, size), workspace);
  });
  double sum = 0.0;
  for (const double loss : losses) {
    sum += loss;
  }
  return sum / static_cast<double>(samples.inputs.cols());
}

NetworkTraining trainNetwork(Network initial, const BatchSource& source, const Samples& held_out,
                             const TrainingOptions& options) {
  NetworkTraining training = Trainer(std::move(initial), source, held_out, options).run();
  training.network = roundWeights(std::move(training.network));
  return training;
}

}  // namespace twinmap::network
