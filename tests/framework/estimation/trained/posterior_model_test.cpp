#include "framework/estimation/trained/posterior_model.hpp"

#include <gtest/gtest.h>

#include "framework/estimation/surrogate/online_surrogate.hpp"
#include "tests/framework/estimation/trained/oscillation.hpp"

namespace twinmap {
namespace {

using testing::Oscillation;

/// A surrogate of which the cross-validation is known alone.
OnlineSurrogate makeSurrogate(double scale_d, double scale_w) {
  Surrogate surrogate;
  surrogate.validation.stddev_scale = Eigen::Vector2d(scale_d, scale_w);
  return OnlineSurrogate(std::make_shared<const Surrogate>(std::move(surrogate)));
}

std::optional<TrustModel> makeTrust(double p_d, double p_w, double p_together) {
  TrustModel trust;
  trust.posteriors = {150, Eigen::Vector3d(p_d, p_w, p_together)};
  return trust;
}

const std::vector<ParameterSpec>& getParameters() {
  static const std::vector<ParameterSpec> parameters = Oscillation().parameters;
  return parameters;
}

TEST(PosteriorDoubt, IsOfAParameterWhoseStandardDeviationsHadToBeEnlarged) {
  EXPECT_EQ(findPosteriorDoubt(makeSurrogate(1.0, 1.15), std::nullopt, getParameters()), "");
  const std::string doubt = findPosteriorDoubt(makeSurrogate(1.0, 1.3), std::nullopt, getParameters());
  EXPECT_NE(doubt.find("too narrow"), std::string::npos);
  EXPECT_NE(doubt.find(": w"), std::string::npos);
}

TEST(PosteriorDoubt, FollowsTheRanksAloneWhereARunHasThem) {
  EXPECT_EQ(findPosteriorDoubt(makeSurrogate(1.0, 1.3), makeTrust(0.2, 0.01, 0.4), getParameters()), "");
  const std::string doubt =
      findPosteriorDoubt(makeSurrogate(1.0, 1.0), makeTrust(0.2, 1e-5, 1e-30), getParameters());
  EXPECT_NE(doubt.find("150 test samples"), std::string::npos);
  EXPECT_NE(doubt.find("w, all parameters together"), std::string::npos);
}

TEST(PosteriorDoubt, IsOfAnotherMapsSurrogateUnlessItsRanksAreKnown) {
  const OnlineProcesses map(compressMap(Oscillation().trainMap(60)));
  EXPECT_NE(findPosteriorDoubt(map, TrustModel(), getParameters()), "");
  EXPECT_EQ(findPosteriorDoubt(map, makeTrust(0.2, 0.01, 0.4), getParameters()), "");
}

TEST(FindUneven, NamesWhatRightPosteriorsShowOnceInAThousandSets) {
  EXPECT_EQ(findUneven(Eigen::Vector3d(0.5, 4e-4, 0.1)), std::vector<Eigen::Index>());
  EXPECT_EQ(findUneven(Eigen::Vector3d(0.5, 3e-4, 0.1)), std::vector<Eigen::Index>{1});
}

}  // namespace
}  // namespace twinmap
