#include "framework/estimation/refined/thinned_misfit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/estimation/refined/misfit.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeVector;

/// y = a^2 sin(t / 30) + b at any times.
class Wave final : public Simulator {
 public:
  explicit Wave(const VectorXd& times) : layout_{{"y"}, {"m"}, times, 0} {}
  const ResponseLayout& getLayout() const override { return layout_; }
  void simulate(const Eigen::Ref<const MatrixXd>& parameters, Eigen::Ref<MatrixXd> responses,
                SampleStatus* statuses) override {
    MatrixXd derivatives;
    simulateWithDerivatives(parameters, responses, derivatives, statuses);
  }
  bool hasDerivatives() const override { return true; }
  void simulateWithDerivatives(const Eigen::Ref<const MatrixXd>& parameters, Eigen::Ref<MatrixXd> responses,
                               MatrixXd& derivatives, SampleStatus* statuses) override {
    const VectorXd wave = (layout_.times.array() / 30.0).sin();
    derivatives.resize(wave.size(), 2 * parameters.cols());
    for (Index i = 0; i < parameters.cols(); ++i) {
      const double a = parameters(0, i);
      responses.col(i) = a * a * wave.array() + parameters(1, i);
      derivatives.col(2 * i) = 2.0 * a * wave;
      derivatives.col(2 * i + 1).setOnes();
      statuses[i] = a > 2.9 ? SampleStatus{false, "too large"} : SampleStatus{};
    }
  }
  std::unique_ptr<Simulator> clone() const override { return std::make_unique<Wave>(*this); }
  std::unique_ptr<Simulator> cloneAt(const VectorXd& times) const override {
    return std::make_unique<Wave>(times);
  }

 private:
  ResponseLayout layout_;
};

constexpr int kTimes = 600;

struct Measured {
  explicit Measured(double noise)
      : simulator(VectorXd::LinSpaced(kTimes, 1.0, kTimes)),
        unknown(testing::makeParameters(2, 1.0, 3.0)),
        extractor({SamplesFeatureSpec{{{"y", {}}}, 1.0, 1.0, kTimes}}, simulator.getLayout()),
        features_noise(extractor, ResponseNoise(VectorXd::Constant(kTimes, noise)), 1),
        model(unknown, extractor, features_noise),
        box(unknown, {0, 2}, VectorXd::Zero(2)),
        features(measure(2.0, 1.5)),
        misfit(simulator, model, box, features) {}

  VectorXd measure(double a, double b) {
    MatrixXd response(kTimes, 1);
    SampleStatus status;
    simulator.simulate(makeVector({a, b}), response, &status);
    return response.col(0);
  }

  Wave simulator;
  const std::vector<ParameterSpec> unknown;
  FeatureExtractor extractor;
  FeatureNoise features_noise;
  RefinementModel model;
  const SearchBox box;
  const VectorXd features;
  Misfit misfit;
};

TEST(ThinnedMisfit, IsNearlyThatOfAllSamples) {
  Measured measured(0.1);
  const auto thinned = measured.misfit.makeThinned();
  ASSERT_NE(thinned, nullptr);
  const MatrixXd points = (MatrixXd(2, 2) << 0.3, -0.5, 0.1, -0.2).finished();
  const std::vector<LocalMisfit> whole = measured.misfit.linearizeAll(points),
                                 few = thinned->linearizeAll(points);
  const VectorXd misfits = thinned->evaluate(points);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(few[i].residuals, 20);
    EXPECT_NEAR(few[i].chi_square / whole[i].chi_square, 1.0, 0.1);
    EXPECT_NEAR(few[i].misfit, misfits[static_cast<Index>(i)], 1e-9 * few[i].misfit);
    EXPECT_LT((few[i].information - whole[i].information).norm(), 0.1 * whole[i].information.norm());
    EXPECT_LT((few[i].descent - whole[i].descent).norm(), 0.1 * whole[i].descent.norm());
  }
}

TEST(ThinnedMisfit, LeadsToWhereAllSamplesLead) {
  Measured measured(0.1);
  const auto thinned = measured.misfit.makeThinned();
  VectorXd at = makeVector({0.4, 0.4});
  for (int i = 0; i < 8; ++i) {
    const LocalMisfit local = thinned->linearizeAll(at).front();
    at += local.calcCovariance() * local.descent;
  }
  const VectorXd point = measured.box.makePoint(at);
  EXPECT_NEAR(point[0], 2.0, 1e-3);
  EXPECT_NEAR(point[1], 1.5, 1e-3);
}

TEST(ThinnedMisfit, SaysWhereASimulationFails) {
  Measured measured(0.1);
  const auto thinned = measured.misfit.makeThinned();
  const MatrixXd point = makeVector({0.95, 0.0});
  EXPECT_FALSE(thinned->linearizeAll(point).front().status.ok);
  EXPECT_TRUE(std::isinf(thinned->evaluate(point)[0]));
}

TEST(ThinnedMisfit, IsNoneWhereAllTimesCostAsMuch) {
  const auto line = [](const VectorXd& x) { return VectorXd(VectorXd::Constant(kTimes, x[0])); };
  testing::Problem problem(kTimes, line, testing::makeParameters(1, 1.0, 3.0), 0.1);
  const SearchBox box(problem.model.getUnknown(), {0, 1}, VectorXd::Zero(1));
  const VectorXd features = line(makeVector({2.0}));
  EXPECT_EQ(Misfit(problem.simulator, problem.model, box, features).makeThinned(), nullptr);
}

TEST(ChooseTimes, KeepsFiveTimesAsManySamplesAsParameters) {
  const ResponseLayout layout{{"x", "y"}, {"m", "m"}, VectorXd::LinSpaced(1000, 0.0, 999.0), 0};
  const VectorXd times = chooseTimes(layout, 2000, 10);
  EXPECT_NEAR(static_cast<double>(2 * times.size()), 50.0, 4.0);
  EXPECT_EQ(chooseTimes(layout, 2000, 250).size(), 0);
}

}  // namespace
}  // namespace twinmap
