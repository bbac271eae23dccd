#include "framework/diagnosis/change_or_term.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A mass on a spring is let go; it may have a spring that hardens, which the model has not.
const std::string kRing = std::string(TWINMAP_SOURCE_DIR) + "/bench/framework/tracking/ring.yaml";

class Ring {
 public:
  explicit Ring(double hardening)
      : machine_(loadExperiment(kRing, {"constants.hardening=" + std::to_string(hardening)})) {
    recordings_.all.layout = makeLayout(experiment_);
  }

  /// A recording of a machine of stiffness k that starts at x0; the change is before the first that follows
  /// setChange().
  void measure(double k, double x0) {
    const ResponseLayout& layout = recordings_.all.layout;
    const Vector3d point(k, 0.6, x0);
    MatrixXd response(layout.getRowCount(), 1);
    SampleStatus status;
    makeTrustedSimulator(machine_.model, layout.times)->simulate(point, response, &status);
    const auto seed = static_cast<std::uint64_t>(recordings_.inferred.size());
    const MatrixXd noisy =
        addNoise(response, ResponseNoise(machine_.noise, layout), {seed, RandomPurpose::kTestNoise});
    recordings_.all.features.push_back(makeExtractor(machine_, layout).extract(noisy).col(0));
    recordings_.inferred.emplace_back();
    recordings_.inferred.back().explanation = point;
  }
  void setChange() { recordings_.before = recordings_.inferred.size(); }

  ChangeOrTerm weigh() const { return weighChangeOrTerm(experiment_, recordings_); }

 private:
  const ExperimentSpec experiment_ = loadExperiment(kRing), machine_;
  ChangeRecordings recordings_;
};

TEST(WeighChange, IsTheEvidenceOfTheParameterThatDiffers) {
  // two parameters, each seen by a residual before and one after; the first differs by 6 of its sds
  LinearizedRecordings linear{VectorXd(4), MatrixXd(4, 2), {0}};
  linear.residual << -3.0, 0.0, 3.0, 0.0;
  linear.jacobian << 1, 0, 0, 1, 1, 0, 0, 1;
  const ChangeEvidence change = weighChange(linear, 2, Vector2d(50.0, 50.0));
  EXPECT_EQ(change.parameters, std::vector<std::size_t>{0});
  // the difference is 6 with the sd of two values, and takes all 18 of chi-square
  EXPECT_NEAR(change.log_evidence, calcLogEvidence(18.0, {6.0, std::sqrt(2.0), 50.0}), 1e-9);
  EXPECT_TRUE(
      weighChange({VectorXd::Zero(4), linear.jacobian, {0}}, 2, Vector2d(50.0, 50.0)).parameters.empty());
}

TEST(ChangeOrTerm, OfAMissingTermIsTheTermWithOneSetOfParameters) {
  Ring ring(9000.0);
  ring.measure(200.0, 0.055);
  ring.measure(200.0, 0.05);
  ring.setChange();
  ring.measure(200.0, 0.03);
  ring.measure(200.0, 0.025);
  const ChangeOrTerm weighed = ring.weigh();
  EXPECT_FALSE(weighed.change.parameters.empty());  // without the term the stiffness falls
  EXPECT_GT(weighed.change.log_evidence, 3.0);
  ASSERT_TRUE(weighed.rival.has_value());
  EXPECT_TRUE(weighed.rival->term.explains);
  EXPECT_GT(weighed.rival->over_change, 0.0);
  EXPECT_LE(weighed.rival->left, 3.0);
  const std::vector<std::string>& others = weighed.rival->term.rivals;
  EXPECT_TRUE(weighed.rival->term.term == "cubic_spring.x" ||
              std::find(others.begin(), others.end(), "cubic_spring.x") != others.end())
      << weighed.rival->term.term;
}

TEST(ChangeOrTerm, OfWearIsTheChangeWhateverTheMotion) {
  Ring ring(0.0);
  ring.measure(200.0, 0.055);
  ring.measure(200.0, 0.04);
  ring.setChange();
  ring.measure(197.0, 0.03);
  ring.measure(197.0, 0.025);
  const ChangeOrTerm weighed = ring.weigh();
  EXPECT_EQ(weighed.change.parameters, std::vector<std::size_t>{0});
  EXPECT_GT(weighed.change.log_evidence, 3.0);
  EXPECT_FALSE(weighed.rival.has_value());
}

TEST(ChangeOrTerm, OfWearBesideAMissingTermIsTheChange) {
  Ring ring(9000.0);
  for (const double k : {200.0, 188.0}) {  // both sides move alike: the term explains no difference
    ring.measure(k, 0.05);
    ring.measure(k, 0.03);
    if (k == 200.0) {
      ring.setChange();
    }
  }
  const ChangeOrTerm weighed = ring.weigh();
  EXPECT_EQ(weighed.change.parameters.front(), 0U);
  EXPECT_FALSE(weighed.rival.has_value());
}

}  // namespace
}  // namespace twinmap
