#include "framework/inference/clock/clocked_simulator.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// sin(a t) + b, of parameters a and b.
class Sine final : public Simulator {
 public:
  explicit Sine(VectorXd times) : layout_{{"y"}, {"m"}, std::move(times)} {}

  const ResponseLayout& getLayout() const override { return layout_; }
  void simulate(const Eigen::Ref<const MatrixXd>& parameters, Eigen::Ref<MatrixXd> responses,
                SampleStatus* statuses) override {
    for (Index j = 0; j < parameters.cols(); ++j) {
      responses.col(j) = (parameters(0, j) * layout_.times.array()).sin() + parameters(1, j);
      statuses[j] = {};
    }
  }
  bool hasDerivatives() const override { return true; }
  void simulateWithDerivatives(const Eigen::Ref<const MatrixXd>& parameters, Eigen::Ref<MatrixXd> responses,
                               MatrixXd& derivatives, SampleStatus* statuses) override {
    simulate(parameters, responses, statuses);
    derivatives.resize(layout_.times.size(), 2 * parameters.cols());
    for (Index j = 0; j < parameters.cols(); ++j) {
      derivatives.col(2 * j) = layout_.times.array() * (parameters(0, j) * layout_.times.array()).cos();
      derivatives.col(2 * j + 1).setOnes();
    }
  }
  std::unique_ptr<Simulator> clone() const override { return std::make_unique<Sine>(layout_.times); }

 private:
  ResponseLayout layout_;
};

const ClockedSimulator::Times kClock{
    VectorXd::LinSpaced(30, 0.1, 3.0), {{"late", 0.02}, {"late", 0.05, 0.0, 1.5}}, 0.025, 3.0};

ClockedSimulator makeClocked() {
  return {std::make_unique<Sine>(kClock.listAll()), kClock, 1};
}

/// a, the two sizes, b.
VectorXd simulate(ClockedSimulator& simulator, const VectorXd& point) {
  VectorXd response(simulator.getLayout().getRowCount());
  SampleStatus status;
  simulator.simulate(point, response, &status);
  return response;
}

TEST(ClockedSimulator, HasTheResponseAtTheTrueTimes) {
  ClockedSimulator simulator = makeClocked();
  const VectorXd response = simulate(simulator, VectorXd{{2.0, 0.021, 0.052, 0.3}});
  for (Index i = 0; i < response.size(); ++i) {
    const double stamp = kClock.stamps[i];
    EXPECT_NEAR(response[i], std::sin(2.0 * (stamp - 0.021 - (stamp < 1.5 ? 0.0 : 0.052))) + 0.3, 2e-5)
        << stamp;
  }
}

TEST(ClockedSimulator, HasDerivativesThatAreDifferences) {
  ClockedSimulator simulator = makeClocked();
  const VectorXd point{{2.0, 0.021, 0.052, 0.3}};
  VectorXd response(simulator.getLayout().getRowCount());
  MatrixXd derivatives;
  SampleStatus status;
  simulator.simulateWithDerivatives(point, response, derivatives, &status);
  constexpr double kStep = 1e-6;
  for (Index k = 0; k < point.size(); ++k) {
    VectorXd up = point, down = point;
    up[k] += kStep;
    down[k] -= kStep;
    const VectorXd difference = (simulate(simulator, up) - simulate(simulator, down)) / (2.0 * kStep);
    EXPECT_LT((difference - derivatives.col(k)).cwiseAbs().maxCoeff(), 1e-7) << k;
  }
}

TEST(ClockedSimulator, KnowsWhichStampsCannotBeSimulated) {
  EXPECT_TRUE(kClock.isWithin(0.1));
  EXPECT_FALSE(kClock.isWithin(0.04));
  EXPECT_EQ(kClock.calcTrueTime(0.0), kClock.reach);
}

TEST(ClockFault, IsSaidInWords) {
  const NuisanceSize late{"late", 0.02, 1e-4}, slow{"rate", -0.003, 1e-5}, slip{"late", 0.0024, 1e-4, 15.28},
      back{"late", -0.001, 1e-4, 3.5};
  EXPECT_EQ(describeClock({late}), "the record is 20 ms late (sd 0.1 ms)");
  EXPECT_EQ(describeClock({slow}), "the clock runs 0.299 % slow (sd 0.001 %)");
  EXPECT_EQ(describeClock({slip}), "from t = 15.28 s on the record is 2.4 ms late (sd 0.1 ms)");
  EXPECT_EQ(describeClock({slip, back}),
            "from t = 3.5 s on the record is 1 ms early (sd 0.1 ms); from t = 15.28 s on it is 2.4 ms later "
            "(sd 0.1 ms)");
  EXPECT_EQ(describeClock({late, slow}),
            "the record is 20 ms late (sd 0.1 ms); the clock runs 0.299 % slow (sd 0.001 %)");
}

}  // namespace
}  // namespace twinmap
