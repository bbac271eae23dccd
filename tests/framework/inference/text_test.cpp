#include <gtest/gtest.h>

#include "framework/base/json/json.hpp"
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

/// An unreliable posterior of m and L, of which three places show the product 2 +- .1 alone, and of c, 0.4 +-
/// .02.
InferredMeasurement makeValley(const std::vector<ParameterSpec>& parameters) {
  SimulatorPosterior posterior;
  posterior.message = "few draws";
  constexpr Eigen::Index kPlaces = 3, kEach = 2;
  posterior.floor.points.resize(3, kPlaces * kEach);
  posterior.floor.weights = Eigen::VectorXd::Constant(kPlaces * kEach, 1.0 / (kPlaces * kEach));
  posterior.floor.scales = Eigen::VectorXd::Zero(kPlaces * kEach);
  for (Eigen::Index i = 0; i < kPlaces * kEach; ++i) {
    const double m = 1.0 + static_cast<double>(i / kEach), side = i % kEach == 0 ? 1.0 : -1.0;
    posterior.floor.points.col(i) << m, (2.0 + 0.1 * side) / m, 0.4 + 0.02 * side;
    posterior.floor.places.push_back(static_cast<int>(i / kEach));
  }
  InferredMeasurement inferred;
  inferred.source = "m.csv";
  inferred.posterior = makePosteriorEstimate(posterior, parameters, 3, {});
  inferred.posterior->fit->degrees = 10.0;
  Ridge ridge{{0, 1}, 1, {{{Eigen::Vector3i(1, 1, 0)}, {1.0}, 0.0}}};
  inferred.ridges = {ridge};
  return inferred;
}

std::vector<ParameterSpec> makeThree() {
  std::vector<ParameterSpec> parameters(3);
  const char* names[] = {"m", "L", "c"};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    parameters[i].name.text = names[i];
    parameters[i].bounds = {0.1, 5.0, {}};
  }
  return parameters;
}

TEST(UnreliablePosteriors, StillSayWhatIsDetermined) {
  const std::vector<ParameterSpec> parameters = makeThree();
  const InferredMeasurement inferred = makeValley(parameters);
  const std::string text = makeInferenceTable(inferred, parameters, {});
  EXPECT_NE(text.find("  m * L            2     0.1"), std::string::npos) << text;
  EXPECT_NE(text.find("  c                0.4   0.02"), std::string::npos) << text;
  EXPECT_EQ(text.find("  m          "), std::string::npos) << text;
  EXPECT_NE(text.find("Fix 1 of m, L at known values"), std::string::npos) << text;
  EXPECT_EQ(text.find("--posterior"), std::string::npos) << text;
  const Json json = parseJson(makeInferenceJson(inferred, parameters, {}));
  EXPECT_EQ(json["status"], "unreliable");
  EXPECT_NEAR(json["identified"][0]["mean"].get<double>(), 2.0, 1e-12);
  EXPECT_NEAR(json["identified"][0]["sd"].get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(json["parameters"]["c"]["sd"].get<double>(), 0.02, 1e-12);
  EXPECT_FALSE(json["parameters"].contains("m"));
  const std::string csv = makeInferenceCsvRows(inferred, parameters, false);
  EXPECT_NE(csv.find("m.csv,0,m,,,,,,unreliable"), std::string::npos) << csv;
  EXPECT_NE(csv.find("m.csv,0,m * L,,2"), std::string::npos) << csv;
}

TEST(UnreliablePosteriors, SayNothingOfCombinationsThatChangeAlongTheValley) {
  const std::vector<ParameterSpec> parameters = makeThree();
  InferredMeasurement inferred = makeValley(parameters);
  inferred.ridges[0].combinations = {{{Eigen::Vector3i(1, 2, 0)}, {1.0}, 0.0}};
  const Json json = parseJson(makeInferenceJson(inferred, parameters, {}));
  EXPECT_EQ(json["identified"][0]["expression"], "m * L^2");
  EXPECT_FALSE(json["identified"][0].contains("mean"));
  EXPECT_EQ(makeInferenceTable(inferred, parameters, {}).find("\n  m * L^2 "), std::string::npos);
}

}  // namespace
}  // namespace twinmap
