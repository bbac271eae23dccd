#include "framework/study/samples/ineffective_parameters.hpp"

#include <gtest/gtest.h>

#include "tests/framework/study/samples/counting_simulator.hpp"

namespace twinmap {
namespace {

std::vector<ParameterSpec> makeParameters(Bounds first) {
  std::vector<ParameterSpec> parameters(2);
  parameters[0].name.text = "p0";
  parameters[0].bounds = first;
  parameters[1].name.text = "p1";
  parameters[1].bounds.lower = 1.0;
  parameters[1].bounds.upper = 2.0;
  return parameters;
}

/// Sees p1 only.
class DeafSimulator final : public CountingSimulator {
 public:
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override {
    Eigen::MatrixXd heard = parameters;
    heard.row(0).setOnes();
    CountingSimulator::simulate(heard, responses, statuses);
  }
  std::unique_ptr<Simulator> clone() const override { return std::make_unique<DeafSimulator>(*this); }
};

Bounds makeBounds(double lower, double upper) {
  Bounds bounds;
  bounds.lower = lower;
  bounds.upper = upper;
  return bounds;
}

TEST(IneffectiveParameters, AreThoseThatChangeNothing) {
  EXPECT_EQ(findIneffective(DeafSimulator(), makeParameters(makeBounds(1.0, 2.0))),
            std::vector<std::string>{"p0"});
  EXPECT_TRUE(findIneffective(CountingSimulator(), makeParameters(makeBounds(1.0, 2.0))).empty());
}

TEST(IneffectiveParameters, AreNotThoseWhoseProbesAllFailed) {
  EXPECT_TRUE(findIneffective(CountingSimulator(), makeParameters(makeBounds(7.0, 7.0))).empty());
}

TEST(IneffectiveParameters, AreNamedInOneSentence) {
  EXPECT_EQ(describeIneffective({}), "");
  EXPECT_EQ(describeIneffective({"k"}).rfind("k has no effect", 0), 0u);
  EXPECT_EQ(describeIneffective({"k", "d"}).rfind("k, d has no effect", 0), 0u);
}

}  // namespace
}  // namespace twinmap
