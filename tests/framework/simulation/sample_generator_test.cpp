#include "framework/simulation/sample_generator.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace twinmap {
namespace {

/// Two outputs at three times: p0 * t and p0 + p1; fails where p0 is 0, throws where p0 is -1.
class FakeSimulator : public Simulator {
 public:
  const ResponseLayout& getLayout() const override { return layout_; }

  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override {
    largest_batch = std::max(largest_batch.load(), static_cast<int>(parameters.cols()));
    for (Eigen::Index j = 0; j < parameters.cols(); ++j) {
      statuses[j] = simulateOne(parameters.col(j), responses.col(j));
    }
  }

  std::unique_ptr<Simulator> clone() const override { return std::make_unique<FakeSimulator>(*this); }

  static inline std::atomic<int> largest_batch{0};

 private:
  SampleStatus simulateOne(const Eigen::Ref<const Eigen::VectorXd>& p, Eigen::Ref<Eigen::VectorXd> response) {
    if (p[0] == -1.0) {
      throw std::logic_error("a bug");
    }
    if (p[0] == 0.0) {
      response.setConstant(std::numeric_limits<double>::quiet_NaN());
      return {false, "p0 is zero"};
    }
    response << p[0] * layout_.times, Eigen::VectorXd::Constant(3, p[0] + p[1]);
    return {};
  }

  ResponseLayout layout_{{"a", "b"}, {"m", "rad"}, Eigen::VectorXd::LinSpaced(3, 1.0, 3.0)};
};

Eigen::MatrixXd makePoints(int count) {
  Eigen::MatrixXd points(2, count);
  for (int j = 0; j < count; ++j) {
    points.col(j) << j + 1.0, 0.5 * j;
  }
  return points;
}

TEST(GenerateSamples, FillsOneColumnASample) {
  const Trajectories result = generateSamples(FakeSimulator(), makePoints(4));
  EXPECT_EQ(result.parameters, makePoints(4));
  EXPECT_EQ(result.layout.output_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(result.layout.output_units, (std::vector<std::string>{"m", "rad"}));
  Eigen::VectorXd expected(6);
  expected << 3, 6, 9, 4, 4, 4;
  EXPECT_EQ(result.responses.col(2), expected);
  EXPECT_EQ(result.calcFailureCount(), 0);
}

TEST(GenerateSamples, FailedSampleKeepsItsPlace) {
  Eigen::MatrixXd points = makePoints(5);
  const Trajectories whole = generateSamples(FakeSimulator(), points);
  points(0, 2) = 0.0;
  const Trajectories result = generateSamples(FakeSimulator(), points);
  EXPECT_EQ(result.calcFailureCount(), 1);
  EXPECT_EQ(result.statuses[2].reason, "p0 is zero");
  EXPECT_TRUE(result.responses.col(2).array().isNaN().all());
  for (const int j : {0, 1, 3, 4}) {
    EXPECT_TRUE(result.statuses[j].ok);
    EXPECT_EQ(result.responses.col(j), whole.responses.col(j));
  }
}

TEST(GenerateSamples, AnyThreadCountAndBatchSizeGivesTheSameBits) {
  const Eigen::MatrixXd points = makePoints(23);
  const Trajectories reference = generateSamples(FakeSimulator(), points, {1, 1, {}});
  for (const int threads : {1, 2, 3, 5}) {
    for (const int batch : {1, 4, 100}) {
      EXPECT_EQ(generateSamples(FakeSimulator(), points, {threads, batch, {}}).responses,
                reference.responses);
    }
  }
}

TEST(GenerateSamples, HandsOverBatchesOfTheAskedSize) {
  FakeSimulator::largest_batch = 0;
  generateSamples(FakeSimulator(), makePoints(10), {1, 4, {}});
  EXPECT_EQ(FakeSimulator::largest_batch, 4);
}

TEST(GenerateSamples, ThrowsABugAgainAfterTheLoop) {
  Eigen::MatrixXd points = makePoints(20);
  points(0, 7) = -1.0;
  EXPECT_THROW(generateSamples(FakeSimulator(), points, {3, 1, {}}), std::logic_error);
}

TEST(GenerateSamples, ReportsProgressUpToTheNumberOfSamples) {
  int last = 0, calls = 0;
  generateSamples(FakeSimulator(), makePoints(11), {3, 2, [&](int done) {
                                                      EXPECT_GT(done, last);
                                                      last = done;
                                                      ++calls;
                                                    }});
  EXPECT_EQ(last, 11);
  EXPECT_EQ(calls, 6);
}

TEST(GenerateSamples, NoSamplesGiveNoColumns) {
  const Trajectories result = generateSamples(FakeSimulator(), Eigen::MatrixXd(2, 0));
  EXPECT_EQ(result.responses.rows(), 6);
  EXPECT_EQ(result.responses.cols(), 0);
}

TEST(GenerateSamples, RefusesSenselessOptions) {
  EXPECT_THROW(generateSamples(FakeSimulator(), makePoints(2), {1, 0, {}}), std::invalid_argument);
  EXPECT_THROW(generateSamples(FakeSimulator(), makePoints(2), {-1, 1, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
