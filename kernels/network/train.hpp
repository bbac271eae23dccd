#pragma once

#include <functional>

#include "kernels/gp/stop.hpp"
#include "kernels/network/network.hpp"
#include "kernels/network/soap.hpp"

namespace twinmap::network {

/// Samples with their targets.
struct Samples {
  MatrixXd inputs;   ///< k x n
  MatrixXd targets;  ///< p x n
};

/// Fills `samples` (of their sizes already) with those numbered first, first + 1 ... of the batch of a step.
/// Called from several threads; must not throw, and must depend on the numbers alone.
using BatchSource = std::function<void(Index step, Index first, Samples& samples)>;

struct TrainingOptions {
  Index steps = 8000;
  Index batch = 256;
  double learning_rate = 0.002;  ///< .01 diverges on strongly nonlinear cases
  double warm_up = 0.02;         ///< share of the steps in which the rate grows from 0; then half a cosine
  Index check_interval = 200;    ///< steps between two looks at the samples held out
  SoapOptions soap{};
  int threads = 1;
  gp::StopFlag stop = nullptr;
};

/// How a training went.
struct NetworkTraining {
  Network network;                    ///< of the best check, weights rounded (roundWeights)
  std::vector<double> held_out_loss;  ///< mean a sample, of t's density, at each check, the first before all
  Index best_check = 0;
  int restarts = 0;  ///< times that a step was not finite: back to the best check, at half the rate
};

/// Minimises the mean loss (backpropagation.hpp) by SOAP, and returns the network that was best on samples
/// held out. A batch is parted in chunks of 64 samples, whose gradients are added in their order, so that the
/// result is the same bit for bit for any number of threads. Throws gp::Stopped. Cost: a step 6 flops a
/// weight and sample, and those of SoapMatrix.
NetworkTraining trainNetwork(Network initial, const BatchSource& source, const Samples& held_out,
                             const TrainingOptions& options);

/// The mean loss a sample.
double calcMeanLoss(const Network& network, const Samples& samples, int threads);

}  // namespace twinmap::network
