#include "framework/diagnosis/remainder/remainder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

/// Of a cart whose sensor errs by `size` sds of its noise, one sample much like the next; at the true
/// parameters.
std::optional<Remainder> findOfErrors(double size) {
  constexpr double kAlike = 0.6;
  const ExperimentSpec experiment = loadExperiment(kCart);
  const double stddev = experiment.noise.stddev[0].stddev;
  const RandomStream random(5, RandomPurpose::kTestNoise);
  Eigen::VectorXd measured = measureCart(kSound);
  double error = 0.0;
  for (Eigen::Index i = 0; i < measured.size(); ++i) {
    error = kAlike * error +
            std::sqrt(1.0 - kAlike * kAlike) * random.calcNormal(static_cast<std::uint64_t>(i), 0);
    measured[i] += size * stddev * error;
  }
  return findRemainder(experiment, {makeLayout(experiment), {measured}, {}}, kTrueCart, 3);
}

// A strong error is none of a force; a weak one may be, and a force makes the damping less certain.
TEST(Remainder, NamesProcessesThatAreNotToldApart) {
  const std::optional<Remainder> weak = findOfErrors(1.0), strong = findOfErrors(2.0);
  ASSERT_TRUE(weak && strong);
  for (const Remainder& one : {*weak, *strong}) {
    EXPECT_EQ(one.what, "an error of output x");
    for (Eigen::Index i = 0; i < 3; ++i) {
      EXPECT_NEAR(one.mean[i], kTrueCart[i], 3.0 * one.stddevs[i]);
    }
  }
  EXPECT_EQ(weak->rivals, std::vector<std::string>{"a force on x"});
  EXPECT_TRUE(strong->rivals.empty());
  EXPECT_GT(weak->stddevs[1], 1.2 * strong->stddevs[1]);
}

TEST(Remainder, IsNoneOfNoise) {
  EXPECT_FALSE(findOfErrors(0.0));
}

}  // namespace
}  // namespace twinmap
