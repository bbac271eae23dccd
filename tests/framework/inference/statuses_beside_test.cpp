// Each status beside each other one: no two lines that are printed contradict, and none advises twice.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "framework/inference/joint/joint_inference.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using Cause = std::function<void(InferredMeasurement&)>;
using Causes = std::map<std::string, Cause>;

std::vector<ParameterSpec> makeParameters() {
  ParameterSpec k, d;
  k.name.text = "k";
  k.bounds = {0.0, 2.0, {}};
  d.name.text = "d";
  d.bounds = {0.0, 2.0, {}};
  return {k, d};
}

std::vector<FeatureInfo> makeFeatures() {
  FeatureInfo info;
  info.name = "x(0.1 s)";
  info.output = 0;
  return {info};
}

Estimate makeEstimateOfTwo() {
  Estimate estimate{VectorXd::Ones(2), VectorXd::Constant(2, 0.01)};
  estimate.limit_stddev = VectorXd::Constant(2, 0.01);
  return estimate;
}

void addTrust(InferredMeasurement& inferred, TrustStatus status) {
  if (!inferred.trust) {
    inferred.trust.emplace();
    inferred.trust->anomaly.count = 1;
  }
  inferred.trust->statuses.push_back(status);
  std::sort(inferred.trust->statuses.begin(), inferred.trust->statuses.end());
}

void reject(InferredMeasurement& inferred, RefinementStatus status) {
  inferred.refined.emplace();
  inferred.refined->status = status;
  inferred.refined->message = "rejected";
}

void addDoubtfulPosterior(InferredMeasurement& inferred) {
  inferred.posterior.emplace();
  inferred.posterior->estimate = makeEstimateOfTwo();
  inferred.posterior->doubt = "ranks are not uniform";
}

void addUnreliablePosterior(InferredMeasurement& inferred) {
  inferred.posterior.emplace();
  inferred.posterior->source = PosteriorSource::kSimulator;
  inferred.posterior->message = "few draws";
  inferred.posterior->fit = SimulatorFit{};
  inferred.posterior->fit->degrees = 10.0;
  inferred.posterior->fit->best = VectorXd::Ones(2);
  inferred.asked.draws = 8000;  // so that it advises to narrow the bounds
}

/// Two answers of a trained estimator.
void makeMultimodal(InferredMeasurement& inferred) {
  Mixture& mixture = inferred.by_estimator.mixture;
  mixture.weights = VectorXd::Constant(2, 0.5);
  mixture.means = (MatrixXd(2, 2) << 0.5, 1.5, 1.0, 1.0).finished();
  mixture.stddevs = MatrixXd::Constant(2, 2, 0.01);
  mixture.correlations = {MatrixXd::Identity(2, 2), MatrixXd::Identity(2, 2)};
}

/// What may be said of an estimate of a trained map, refined or not.
Causes listOfMaps() {
  const auto trust = [](TrustStatus status) {
    return [status](InferredMeasurement& inferred) { addTrust(inferred, status); };
  };
  return {
      {"model_mismatch", trust(TrustStatus::kModelMismatch)},
      {"outside_training", trust(TrustStatus::kOutsideTraining)},
      {"at_bounds",
       [](InferredMeasurement& inferred) {
         addTrust(inferred, TrustStatus::kAtBounds);
         inferred.by_estimator.mean[0] = 2.0;
       }},
      {"uninformative",
       [](InferredMeasurement& inferred) {
         addTrust(inferred, TrustStatus::kUninformative);
         inferred.by_estimator.stddev[0] = 0.57;
       }},
      {"multimodal", makeMultimodal},
      {"nonlinear", [](InferredMeasurement& inferred) { reject(inferred, RefinementStatus::kNonlinear); }},
      {"not_refined", [](InferredMeasurement& inferred) { reject(inferred, RefinementStatus::kMisfit); }},
      {"unreliable", addUnreliablePosterior},
      {"posterior_uncalibrated", addDoubtfulPosterior},
      {"uncalibrated", [](InferredMeasurement& inferred) { inferred.estimator_coverage_is_short = true; }},
      {"estimator_limited",
       [](InferredMeasurement& inferred) { inferred.by_estimator.limit_stddev[0] = 1e-3; }}};
}

void addNoiseReport(InferredMeasurement& inferred, const std::function<void(FoundNoise&)>& change) {
  NoiseReport report;
  report.output = "x" + std::to_string(inferred.posterior->fit->noise.size());
  report.stated = 1.0;
  report.found.size_was_inferred = true;
  report.found.effective_samples = 100.0;
  change(report.found);
  inferred.posterior->fit->noise.push_back(report);
}

/// What may be said of the simulator's posterior.
Causes listOfPosteriors() {
  const auto noise = [](double factor) {
    return [factor](InferredMeasurement& inferred) {
      addNoiseReport(inferred, [factor](FoundNoise& found) { found.factor = factor; });
    };
  };
  return {{"model_mismatch",
           [](InferredMeasurement& inferred) { inferred.posterior->fit->test.chi_square_p = 0.0; }},
          {"at_bounds", [](InferredMeasurement& inferred) { inferred.posterior->fit->beyond = {"k"}; }},
          {"outliers", [](InferredMeasurement& inferred) { inferred.posterior->fit->outliers = {"x(1 s)"}; }},
          {"clock_fault", [](InferredMeasurement& inferred) { inferred.nuisance = {Notice::kClockFault}; }},
          {"noise_larger", noise(3.0)},
          {"noise_smaller", noise(0.3)},
          {"noise_coloured",
           [](InferredMeasurement& inferred) {
             addNoiseReport(inferred,
                            [](FoundNoise& found) { found.autoregression = VectorXd::Constant(1, 0.8); });
           }},
          {"sensor_offset",
           [](InferredMeasurement& inferred) {
             addNoiseReport(inferred, [](FoundNoise& found) { found.has_offset = true; });
           }},
          {"multimodal",
           [](InferredMeasurement& inferred) { inferred.posterior->shape = PosteriorShape::kMultimodal; }},
          {"uninformative", [](InferredMeasurement& inferred) {
             inferred.posterior->shape = PosteriorShape::kUninformative;
             inferred.posterior->estimate.stddev[0] = 0.57;
           }}};
}

InferredMeasurement makeOfMap() {
  InferredMeasurement inferred;
  inferred.source = "m.csv";
  inferred.by_estimator = makeEstimateOfTwo();
  return inferred;
}

InferredMeasurement makeOfPosterior() {
  InferredMeasurement inferred;
  inferred.source = "m.csv";
  addUnreliablePosterior(inferred);
  inferred.posterior->message.clear();
  inferred.posterior->estimate = makeEstimateOfTwo();
  inferred.posterior->estimate.method = EstimationMethod::kPosterior;
  inferred.posterior->fit->chi_square = 10.0;
  inferred.posterior->fit->residual = VectorXd::Ones(10);
  inferred.posterior->fit->test.largest = 0;
  inferred.posterior->fit->largest_feature = "x(0.1 s)";
  return inferred;
}

/// Phrases of which one text holds one at most.
const std::vector<std::pair<const char*, const char*>> kContradictions{
    {"Widen the bounds", "by the bounds"},
    {"Widen the bounds", "Narrow the bounds"},
    {"Narrow the bounds", "by the bounds"},
    {"or excite", "larger than the data would permit"},
    {"or excite", "the features determine"},
    {"or excite", "several parameter values may fit"},
    {"normal distribution: --posterior.", "the posterior cannot be trusted"},
    {"normal distribution: --posterior.", "posterior under the surrogate"},
    {"Refine the estimate", "refinement rejected"},
    {"intervals follow it", "the posterior cannot be trusted"},
    {"those of the noise found", "the posterior cannot be trusted"},
    {"the model explains the measurement", "does not explain"},
    {"noise.correlation; or look", "may look alike"}};

void expectConsistent(const std::string& text, const std::string& of) {
  for (const auto& [one, other] : kContradictions) {
    EXPECT_FALSE(text.find(one) != std::string::npos && text.find(other) != std::string::npos)
        << of << ": '" << one << "' beside '" << other << "'\n"
        << text;
  }
  std::multiset<std::string> remedies;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("    ", 0) == 0 && line.find("%:") == std::string::npos) {
      EXPECT_EQ(remedies.count(line), 0U) << of << ": twice\n" << text;
      remedies.insert(line);
    }
  }
  if (text.find("model_mismatch: ") != std::string::npos) {  // first of all the model is to be right
    EXPECT_LE(remedies.size(), 1U) << of << "\n" << text;
  }
}

bool isSaid(const InferredMeasurement& inferred, const std::string& status) {
  const std::vector<std::string> said = listStatuses(inferred);
  return std::find(said.begin(), said.end(), status) != said.end();
}

/// Of all pairs that can be said together; returns how many these are.
int tryAllPairs(const Causes& causes, InferredMeasurement (*make)()) {
  int pairs = 0;
  for (const auto& [first, cause] : causes) {
    InferredMeasurement alone = make();
    cause(alone);
    EXPECT_TRUE(isSaid(alone, first)) << first;
    for (const auto& [second, other] : causes) {
      InferredMeasurement both = make();
      cause(both);
      other(both);
      if (first < second && isSaid(both, first) && isSaid(both, second)) {
        ++pairs;
        expectConsistent(makeInferenceTable(both, makeParameters(), makeFeatures()),
                         first + " and " + second);
      }
    }
  }
  return pairs;
}

TEST(StatusesBesideEachOther, DoNotContradictOfAMap) {
  EXPECT_GT(tryAllPairs(listOfMaps(), makeOfMap), 40);
}

TEST(StatusesBesideEachOther, DoNotContradictOfAPosterior) {
  EXPECT_GT(tryAllPairs(listOfPosteriors(), makeOfPosterior), 35);
}

TEST(StatusesBesideEachOther, DoNotAdviseToExciteWhatARidgeLeavesOpen) {
  InferredMeasurement inferred = makeOfPosterior();
  listOfPosteriors().at("uninformative")(inferred);
  EXPECT_NE(makeInferenceTable(inferred, makeParameters(), makeFeatures()).find("or excite k"),
            std::string::npos);
  Ridge ridge;
  ridge.parameters = {0, 1};
  ridge.dimension = 1;
  ridge.combinations = {{{Eigen::Vector2i(1, 1)}, {1.0}, 0.0}};
  inferred.ridges = {ridge};
  const std::string text = makeInferenceTable(inferred, makeParameters(), makeFeatures());
  EXPECT_NE(text.find("uninformative: the measurement reduces the uncertainty of k"), std::string::npos)
      << text;
  expectConsistent(text, "uninformative and a ridge");
}

TEST(StatusesBesideEachOther, OfAMapSayThatNothingFitsWhereChiSquareSaysSo) {
  InferredMeasurement inferred = makeOfMap();
  addTrust(inferred, TrustStatus::kModelMismatch);
  inferred.trust->chi_square_p_value = 0.4;
  inferred.trust->anomaly_p_value = inferred.trust->p_value = 0.001;
  std::string text = makeInferenceTable(inferred, makeParameters(), makeFeatures());
  EXPECT_EQ(text.find("no parameter values"), std::string::npos) << text;
  EXPECT_NE(text.find("all but one stretch of the recording fits, the largest misfit is in x(0.1 s)"),
            std::string::npos)
      << text;
  inferred.trust->chi_square_p_value = 0.001;
  text = makeInferenceTable(inferred, makeParameters(), makeFeatures());
  EXPECT_NE(text.find("no parameter values within the bounds fit, the largest"), std::string::npos) << text;
}

TEST(StatusesBesideEachOther, HaveNoSegmentsShortenedWhereTheRecordingIsAtFault) {
  InferredMeasurement inferred = makeOfPosterior();
  listOfPosteriors().at("model_mismatch")(inferred);
  inferred.segments = SegmentReport{4, 2.0, 8};
  EXPECT_NE(makeInferenceTable(inferred, makeParameters(), makeFeatures()).find("--segments 1"),
            std::string::npos);
  inferred.fault = "x is 1000 times too large: divide it by 1000";
  EXPECT_EQ(makeInferenceTable(inferred, makeParameters(), makeFeatures()).find("--segments 1"),
            std::string::npos);
}

/// Of a kind that no other file knows.
RecordingNuisance makeTurnedSensor() {
  return {Notice::kClockFault, "turned", {"turn."}, {{"angle", 0.05, 1e-3}}, "the sensor is turned by 3 deg"};
}

TEST(StatusesBesideEachOther, NameTheNuisanceOfARecordingWhateverItIs) {
  InferredMeasurement inferred = makeOfPosterior();
  inferred.nuisance = makeTurnedSensor();
  inferred.nuisance->sizes.push_back({"angle", 0.1, 2e-3, 4.0});
  EXPECT_NE(makeInferenceTable(inferred, makeParameters(), makeFeatures())
                .find("clock_fault: the sensor is turned by 3 deg; the intervals follow it"),
            std::string::npos);
  EXPECT_NE(makeInferenceJson(inferred, makeParameters(), makeFeatures())
                .find(R"("turned":[{"angle":0.05,"sd":0.001},{"angle":0.1,"sd":0.002,"from":4.0}])"),
            std::string::npos);
}

TEST(StatusesBesideEachOther, SayATermBesideANuisanceThatIsNotAlike) {
  InferredMeasurement inferred = makeOfPosterior();
  inferred.nuisance = makeTurnedSensor();
  for (const char* term : {"turn.x", "coulomb.x"}) {
    MissingTerm missing;
    missing.term = term;
    missing.share = 0.95;
    missing.shifts = VectorXd::Zero(2);
    missing.explains = true;
    inferred.model_test = ModelTest{missing};
    const bool is_said = makeInferenceTable(inferred, makeParameters(), makeFeatures())
                             .find("or the model lacks " + missing.term) != std::string::npos;
    EXPECT_EQ(is_said, missing.term == "coulomb.x") << term;
    EXPECT_EQ(isSaid(inferred, "missing_term"), is_said) << term;
    EXPECT_TRUE(isSaid(inferred, "clock_fault")) << term;
  }
}

/// Noise that no status names, as no interval follows it.
TEST(StatusesBesideEachOther, SayThatChiSquareIsOfAnotherNoise) {
  InferredMeasurement inferred = makeOfPosterior();
  listOfPosteriors().at("noise_larger")(inferred);
  std::string text = makeInferenceTable(inferred, makeParameters(), makeFeatures());
  EXPECT_NE(text.find("noise_larger (with that chi-square"), std::string::npos) << text;
  inferred.posterior->message = "few draws";
  text = makeInferenceTable(inferred, makeParameters(), makeFeatures());
  EXPECT_NE(text.find("unreliable (with other noise than stated chi-square"), std::string::npos) << text;
}

JointInference makeJoint() {
  JointInference joint;
  for (const char* name : {"a", "b"}) {
    RecordingInference one{name, makeOfPosterior(), {}};
    one.posterior.mean = one.posterior.stddev = VectorXd::Ones(2);
    joint.alone.push_back(one);
  }
  joint.agreement.emplace();
  joint.joint.mean = joint.joint.stddev = VectorXd::Ones(2);
  joint.joint.message = "few draws";
  joint.together = makeOfPosterior();
  joint.together.posterior->message = "few draws";
  joint.asked.draws = 8000;
  return joint;
}

TEST(StatusesBesideEachOther, DoNotContradictOfRecordingsTogether) {
  const std::map<std::string, std::function<void(JointInference&)>> causes{
      {"model_mismatch",
       [](JointInference& joint) { joint.alone[0].inferred.posterior->fit->test.chi_square_p = 0.0; }},
      {"at_bounds",
       [](JointInference& joint) {
         joint.joint.beyond = {0};
         joint.together.posterior->fit->beyond = {"k"};
       }},
      {"trials_disagree", [](JointInference& joint) { joint.agreement->p_value = 0.0; }},
      {"unreliable", [](JointInference&) {}}};
  for (const auto& [first, cause] : causes) {
    for (const auto& [second, other] : causes) {
      JointInference joint = makeJoint();
      cause(joint);
      other(joint);
      const std::string text = makeJointTable(joint, makeParameters());
      for (const std::string& said : {first, second}) {
        EXPECT_NE(text.find(said), std::string::npos) << said << "\n" << text;
      }
      expectConsistent(text, first + " and " + second);
      EXPECT_EQ(text.find("intervals below"), std::string::npos) << text;  // there are none
    }
  }
}

/// One of many recordings misfits by chance: p is .006, below .01 but not below .01 / 2.
TEST(StatusesBesideEachOther, OfRecordingsTogetherDoNotCallChanceAMismatch) {
  JointInference joint = makeJoint();
  joint.alone[0].inferred.posterior->fit->test.chi_square_p = 0.002;
  ASSERT_EQ(listStatuses(joint, 2).front(), "unreliable");
  const std::string text = makeJointTable(joint, makeParameters());
  EXPECT_EQ(text.find("misfits already alone"), std::string::npos) << text;
}

}  // namespace
}  // namespace twinmap
