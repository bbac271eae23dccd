#include <gtest/gtest.h>

#include <cmath>

#include "framework/diagnosis/picture/output_residuals.hpp"
#include "framework/diagnosis/picture/unknown_force.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A diagnosis of the cart, and what is drawn of it.
struct Picture {
  explicit Picture(const std::vector<VectorXd>& features)
      : experiment(loadExperiment(kCart)),
        recordings{makeLayout(experiment), features, {}},
        diagnosis(diagnose(experiment, recordings, {})),
        motion(diagnosis, experiment, recordings),
        forces(estimateUnknownForces(diagnosis, recordings, motion, features.size())) {}

  ExperimentSpec experiment;
  RecordedFeatures recordings;
  Diagnosis diagnosis;
  FitMotion motion;
  std::vector<UnknownForce> forces;
};

/// Share of the band's knots that hold a force of one quantity, and of those where the force is 0.
template <class Force>
double calcHeld(const ForceCurve& curve, const Force& force) {
  int held = 0;
  for (Index i = 0; i < curve.at.size(); ++i) {
    held += std::abs(curve.mean[i] - force(curve.at[i])) < 1.96 * curve.stddev[i] ? 1 : 0;
  }
  return static_cast<double>(held) / static_cast<double>(curve.at.size());
}

double calcFriction(double speed) {
  return -0.03 * std::tanh(speed / 0.01);
}

TEST(UnknownForce, IsAStepOverTheSpeedWhereDryFrictionIsMissing) {
  const Picture picture({measureCart(kWithFriction), measureCart(kWithFriction, 1)});
  ASSERT_EQ(picture.forces.size(), 1U);
  const UnknownForce& force = picture.forces[0];
  ASSERT_TRUE(force.term.has_value());
  EXPECT_TRUE(force.mayBe(force.over_speed));
  EXPECT_FALSE(force.mayBe(force.over_position));
  EXPECT_GT(calcHeld(force.over_speed, calcFriction), 0.85);
  EXPECT_LT(calcHeld(force.over_speed, [](double) { return 0.0; }), 0.5);
  ASSERT_EQ(force.recordings.size(), 2U);
  for (const ForceOverTime& one : force.recordings) {
    const VectorXd held = (one.force.mean - one.coordinate.speed.unaryExpr(&calcFriction))
                              .cwiseAbs()
                              .cwiseQuotient(1.96 * one.force.stddev);
    EXPECT_GT((held.array() < 1.0).cast<double>().mean(), 0.85);
    // the term's own law, at the fit
    EXPECT_LT((one.term_force - one.fine.speed.unaryExpr(&calcFriction)).norm(), 0.2 * one.term_force.norm());
  }
}

TEST(UnknownForce, IsACurveOverThePositionWhereASpringIsMissing) {
  const Picture picture({measureCart("F - k3*x^3 - 4e5*x^5")});
  const UnknownForce& force = picture.forces.front();
  ASSERT_TRUE(force.term.has_value());
  EXPECT_TRUE(force.mayBe(force.over_position));
  EXPECT_FALSE(force.mayBe(force.over_speed));
  EXPECT_GT(calcHeld(force.over_position, [](double x) { return -4e5 * std::pow(x, 5.0); }), 0.85);
}

TEST(UnknownForce, IsNotAskedForWhereNothingIsMissing) {
  const Picture picture({measureCart(kSound)});
  const UnknownForce& force = picture.forces.front();
  EXPECT_FALSE(force.term.has_value());
  EXPECT_LT(force.getEvidenceOverTime(), 0.0);
  EXPECT_FALSE(force.mayBe(force.over_position) || force.mayBe(force.over_speed));
}

TEST(OutputResiduals, AreThoseOfTheFitsAtTheirPlaces) {
  const Picture picture({measureCart(kWithFriction), measureCart(kWithFriction, 1)});
  const std::vector<OutputResidual> residuals =
      listOutputResiduals(picture.diagnosis, picture.experiment, picture.recordings, picture.motion, 2);
  ASSERT_EQ(residuals.size(), 2U);
  double before = 0.0, after = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(residuals[k].recording, k);
    before += residuals[k].before.squaredNorm();
    after += residuals[k].after.squaredNorm();
    const RecordedMotion moved = picture.motion.simulate(k, picture.recordings.layout.times);
    EXPECT_NEAR(residuals[k].positions.maxCoeff(), moved.coordinates[0].position.maxCoeff(), 1e-9);
    EXPECT_NEAR(residuals[k].speeds.minCoeff(), moved.coordinates[0].speed.minCoeff(), 1e-9);
  }
  EXPECT_NEAR(before, picture.diagnosis.before.posterior.chi_square, 1e-6 * before);
  EXPECT_NEAR(after, picture.diagnosis.after.posterior.chi_square, 1e-6 * after);
  EXPECT_EQ(listOutputResiduals(picture.diagnosis, picture.experiment, picture.recordings, picture.motion, 1)
                .size(),
            1U);
}

}  // namespace
}  // namespace twinmap
