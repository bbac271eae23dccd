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

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

/// With one parameter k, which lies at its bounds.
InferredMeasurement makeAtBounds() {
  InferredMeasurement inferred;
  inferred.source = "m.csv";
  inferred.posterior.emplace();
  inferred.posterior->source = PosteriorSource::kSimulator;
  inferred.posterior->fit = SimulatorFit{};
  inferred.posterior->fit->degrees = 10.0;
  inferred.posterior->fit->beyond = {"k"};
  return inferred;
}

TEST(Remedies, OfStatusesBesideEachOtherDoNotContradict) {
  ParameterSpec k;
  k.name.text = "k";
  k.bounds = {0.0, 2.0, {}};
  InferredMeasurement several = makeAtBounds();
  several.posterior->shape = PosteriorShape::kMultimodal;
  std::string text = describeTrust(several, {k}, {});
  EXPECT_NE(text.find("at_bounds: k lies at its bounds"), std::string::npos) << text;
  EXPECT_EQ(count(text, "Widen"), 0U) << text;  // multimodal has bounds exclude

  InferredMeasurement unreliable = makeAtBounds();
  unreliable.posterior->message = "few draws";
  unreliable.asked.draws = 8000;
  text = makeInferenceTable(unreliable, {k}, {});
  EXPECT_EQ(count(text, "Widen"), 1U) << text;
  EXPECT_EQ(count(text, "Narrow"), 0U) << text;

  InferredMeasurement outside;
  outside.by_estimator = {Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1)};
  outside.trust.emplace();
  outside.trust->statuses = {TrustStatus::kOutsideTraining, TrustStatus::kAtBounds};
  text = describeTrust(outside, {k}, {});
  EXPECT_EQ(count(text, "Widen"), 1U) << text;
}

}  // namespace
}  // namespace twinmap
