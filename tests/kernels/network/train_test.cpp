#include "kernels/network/train.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

#include "kernels/network/predictor.hpp"

namespace twinmap::network {
namespace {

/// x uniform; y normal of mean sin(3 x_0) + x_1 and stddev 0.1 (1 + x_1^2), and y' = y / 2 with noise 0.1.
void fill(Index step, Index first, Samples& samples) {
  for (Index i = 0; i < samples.inputs.cols(); ++i) {
    std::mt19937_64 engine(static_cast<std::uint64_t>(step * 100003 + first + i));
    std::uniform_real_distribution<> uniform(-1.7, 1.7);
    std::normal_distribution<> normal;
    const double a = uniform(engine), b = uniform(engine);
    samples.inputs.col(i) << a, b;
    const double y = std::sin(3.0 * a) + b + 0.1 * (1.0 + b * b) * normal(engine);
    samples.targets.col(i) << y, 0.5 * y + 0.1 * normal(engine);
  }
}

Samples makeSamples(Index count) {
  Samples samples{MatrixXd(2, count), MatrixXd(2, count)};
  fill(1000000, 0, samples);
  return samples;
}

Network makeInitial() {
  const Samples samples = makeSamples(500);
  std::mt19937_64 engine(3);
  std::normal_distribution<> normal;
  return makeNetwork(samples.inputs, samples.targets, {{16, 16}, 1e-8, {}},
                     [&](Index) { return normal(engine); });
}

TrainingOptions makeOptions(Index steps, int threads = 1) {
  TrainingOptions options;
  options.steps = steps;
  options.check_interval = 50;
  options.threads = threads;
  options.learning_rate = 0.005;
  return options;
}

TEST(TrainNetwork, LearnsMeanAndStddevAndCorrelation) {
  const NetworkTraining training = trainNetwork(makeInitial(), fill, makeSamples(1000), makeOptions(1500));
  const Predictor predictor(training.network);
  Predictor::Workspace workspace(predictor);
  for (const double b : {-1.0, 0.0, 1.0}) {
    predictor.predict(Eigen::Vector2d(0.4, b), workspace);
    const double stddev = 0.1 * (1.0 + b * b), variance = stddev * stddev;
    EXPECT_NEAR(workspace.mean[0], std::sin(1.2) + b, 0.3 * stddev);
    EXPECT_NEAR(workspace.stddev[0], stddev, 0.2 * stddev);
    EXPECT_NEAR(workspace.covariance(0, 1), 0.5 * variance, 0.2 * variance);
  }
}

TEST(TrainNetwork, GivesTheSameBitsForAnyNumberOfThreads) {
  const NetworkTraining one = trainNetwork(makeInitial(), fill, makeSamples(300), makeOptions(60, 1));
  const NetworkTraining three = trainNetwork(makeInitial(), fill, makeSamples(300), makeOptions(60, 3));
  EXPECT_EQ(one.held_out_loss, three.held_out_loss);
  for (std::size_t k = 0; k < one.network.layers.size(); ++k) {
    EXPECT_EQ(one.network.layers[k].weights, three.network.layers[k].weights);
    EXPECT_EQ(one.network.layers[k].biases, three.network.layers[k].biases);
  }
}

TEST(TrainNetwork, ReturnsTheBestCheck) {
  // overfits: four samples again and again
  const auto few = [](Index, Index first, Samples& samples) {
    for (Index i = 0; i < samples.inputs.cols(); ++i) {
      Samples one{MatrixXd(2, 1), MatrixXd(2, 1)};
      fill(0, (first + i) % 4, one);
      samples.inputs.col(i) = one.inputs;
      samples.targets.col(i) = one.targets;
    }
  };
  const Samples held_out = makeSamples(300);
  const NetworkTraining training = trainNetwork(makeInitial(), few, held_out, makeOptions(400));
  const auto best = static_cast<std::size_t>(training.best_check);
  EXPECT_EQ(training.held_out_loss[best],
            *std::min_element(training.held_out_loss.begin(), training.held_out_loss.end()));
  EXPECT_EQ(calcMeanLoss(training.network, held_out, 1), training.held_out_loss[best]);
  EXPECT_LT(training.held_out_loss[best], training.held_out_loss.back());
}

TEST(TrainNetwork, GoesBackToTheBestCheckWhereAStepIsNotFinite) {
  const auto broken = [](Index step, Index first, Samples& samples) {
    fill(step, first, samples);
    if (step == 70) {
      samples.targets(0, 0) = std::nan("");
    }
  };
  const NetworkTraining training = trainNetwork(makeInitial(), broken, makeSamples(300), makeOptions(150));
  EXPECT_EQ(training.restarts, 1);
  EXPECT_LT(training.held_out_loss.back(), training.held_out_loss.front());
}

TEST(TrainNetwork, EndsWhenAskedTo) {
  const std::atomic<bool> stop{true};
  TrainingOptions options = makeOptions(100);
  options.stop = &stop;
  EXPECT_THROW(trainNetwork(makeInitial(), fill, makeSamples(300), options), gp::Stopped);
}

}  // namespace
}  // namespace twinmap::network
