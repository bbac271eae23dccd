#include <gtest/gtest.h>

#include "framework/inference/asked.hpp"
#include "framework/inference/text/explain_notice.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {
namespace {

TEST(Asked, IsFilledIntoTheCommandsOfATextAsAShellTakesThem) {
  const std::string text =
      "Ask: twinmap diagnose RUN FILE.\nReplay: twinmap replay RUN FILE.\nAsk: twinmap diagnose FILE "
      "RECORDINGS.\nTry: twinmap simulate FILE.\n";
  EXPECT_EQ(fillCommands(text, {}), text);
  EXPECT_EQ(fillCommands(text, {"my cart.yaml", {"a.csv", "b c.csv"}, {}, {"L=2"}, {0.0, 0.1}}),
            "Ask: twinmap diagnose 'my cart.yaml' a.csv 'b c.csv' --start 0 --start 0.1 --set L=2\n"
            "Replay: twinmap replay 'my cart.yaml' a.csv 'b c.csv' --start 0 --start 0.1 --set L=2\n"
            "Ask: twinmap diagnose 'my cart.yaml' a.csv 'b c.csv' --start 0 --start 0.1 --set L=2\n"
            "Try: twinmap simulate 'my cart.yaml'\n");
  EXPECT_EQ(listArguments({"e.yaml", {}, {"soft=a.csv", "hard=b.csv"}}),
            "e.yaml --trial soft=a.csv --trial hard=b.csv");
  EXPECT_EQ(listArguments({"e.yaml"}), "e.yaml FILE");  // of a stream
}

TEST(Remedies, ThatWereTakenAreNotAdvised) {
  Asked asked;
  EXPECT_NE(explainUnreliable("few", asked).find("Take more draws"), std::string::npos);
  asked.draws = 4000;
  EXPECT_EQ(explainUnreliable("few", asked),
            "  unreliable: the posterior cannot be trusted: few\n"
            "    Narrow the bounds, or measure another output; more draws would hardly help.\n");
}

/// Of a run whose test samples held too little, refined or not.
InferredMeasurement makeUncalibrated() {
  InferredMeasurement inferred;
  inferred.source = "m.csv";
  inferred.estimator_coverage_is_short = true;
  inferred.by_estimator = {Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1)};
  return inferred;
}

TEST(Remedies, OfUncalibratedEstimatesGoOnFromThePosteriorThatIsThere) {
  ParameterSpec k;
  k.name.text = "k";
  k.bounds = {0.0, 2.0, {}};
  InferredMeasurement inferred = makeUncalibrated();
  EXPECT_NE(describeTrust(inferred, {k}, {}).find("normal distribution: --posterior.\n"), std::string::npos);
  inferred.posterior.emplace();
  const std::string text = describeTrust(inferred, {k}, {});
  EXPECT_EQ(text.find("--posterior.\n"), std::string::npos) << text;
  EXPECT_NE(text.find("--posterior-from simulator.\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace twinmap
