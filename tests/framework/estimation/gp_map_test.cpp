#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"

namespace twinmap {
namespace {

/// Two parameters seen through four features (two outputs at two times), smooth, with a little noise.
struct Problem {
  Eigen::MatrixXd parameters, features;
  std::vector<FeatureInfo> infos{
      {"a(0 s)", "", 0, 0.0}, {"a(1 s)", "", 0, 1.0}, {"b(0 s)", "", 1, 0.0}, {"b(1 s)", "", 1, 1.0}};
  std::vector<std::string> names{"p", "q"};
  int replicates = 1;
};

Problem makeProblem(int samples, std::uint64_t seed, double noise_stddev = 1e-4) {
  Problem problem;
  const RandomStream random(seed, RandomPurpose::kTrainDesign);
  problem.parameters.resize(2, samples);
  problem.features.resize(4, samples);
  for (int i = 0; i < samples; ++i) {
    const double p = 1000 + 200 * random.calcUniform(i, 0), q = 1e-4 * (1 + random.calcUniform(i, 1));
    problem.parameters.col(i) << p, q;
    const double a = (p - 1000) / 200, b = q / 1e-4 - 1;
    problem.features.col(i) << std::sin(a) + b, 5 * std::exp(a - b), 0.01 * a * b, b * b + 0.3 * a;
    for (int f = 0; f < 4; ++f) {
      problem.features(f, i) += noise_stddev * random.calcNormal(i, 10 + f);
    }
  }
  return problem;
}

GpMapTraining trainOn(const Problem& problem, const GpMapSpec& spec = {}, int threads = 1) {
  const TransformStepSpec z_score{ZScoreSpec{}, {}};
  const Eigen::Index features = problem.features.rows();
  const Eigen::MatrixXd noise = Eigen::MatrixXd::Identity(features, features);
  return trainGpMap(spec, {z_score}, problem.names,
                    {problem.infos, problem.features, problem.parameters, noise, problem.replicates, {}},
                    {threads});
}

/// Root mean square of the error of 200 other samples, relative to the parameters' spread.
double calcError(const Problem& problem, double noise_stddev) {
  const Problem test = makeProblem(200, 99, noise_stddev);
  const GpMap map = trainOn(problem).map;
  const Eigen::ArrayXXd error = (map.predict(test.features).mean - test.parameters).array();
  return std::sqrt((error.colwise() / map.target_scale.array()).square().mean());
}

TEST(GpMap, InfersParametersInTheirOwnUnits) {
  const GpMapTraining training = trainOn(makeProblem(80, 1));
  const Problem test = makeProblem(50, 2);
  const Estimates predictions = training.map.predict(test.features);
  EXPECT_TRUE(training.warnings.empty());
  const Eigen::MatrixXd error = predictions.mean - test.parameters;
  EXPECT_LT(error.row(0).cwiseAbs().mean(), 1.0);   // of a range of 200
  EXPECT_LT(error.row(1).cwiseAbs().mean(), 1e-6);  // of a range of 1e-4
  const Eigen::ArrayXXd z = error.array() / predictions.stddev.array();
  EXPECT_LT(std::sqrt(z.square().mean()), 2.0);
  EXPECT_GT(std::sqrt(z.square().mean()), 0.5);
}

TEST(GpMap, LengthScalesAreGroupedAsTheSpecSays) {
  const Problem problem = makeProblem(40, 1);
  GpMapSpec spec;
  spec.length_scales = LengthScales::kPerOutput;
  const auto train_first = [&] {
    return std::get<std::shared_ptr<const gp::GaussianProcess>>(trainOn(problem, spec).map.processes[0]);
  };
  EXPECT_EQ(train_first()->getStructure().length_scale_groups, (std::vector<int>{0, 0, 1, 1}));
  spec.length_scales = LengthScales::kPerFeature;
  EXPECT_EQ(train_first()->getHyperparameters().length_scales.size(), 4);
  spec.length_scales = LengthScales::kShared;
  EXPECT_EQ(train_first()->getHyperparameters().length_scales.size(), 1);
}

// Titsias' approximation is exact where every training input is an inducing input.
TEST(GpMap, ASparseMapOnAllInputsIsTheExactOne) {
  constexpr double kNoise = 0.02;  // far above the jitter that inducing inputs need
  const Problem problem = makeProblem(80, 1, kNoise), test = makeProblem(50, 2, kNoise);
  GpMapSpec spec;
  spec.approximation = GpApproximation::kSgpr;
  spec.inducing = 80;
  spec.refine_evaluations = 0;
  const Estimates sparse = trainOn(problem, spec).map.predict(test.features);
  const Estimates exact = trainOn(problem).map.predict(test.features);
  const Eigen::ArrayXXd difference = (sparse.mean - exact.mean).array() / exact.stddev.array();
  EXPECT_LT(difference.abs().maxCoeff(), 1e-2);
  EXPECT_LT((sparse.stddev.array() / exact.stddev.array() - 1.0).abs().maxCoeff(), 1e-2);
}

// Four draws of the noise of 60 samples: the likelihood would best be served by recognising the samples,
// which infers nothing; the map must get better instead.
TEST(GpMap, ReplicatesHelpAndAreNotRecognised) {
  constexpr int kSamples = 60, kReplicates = 4;
  constexpr double kNoise = 0.02;
  Problem problem = makeProblem(kSamples, 5, kNoise);
  const double error_of_one = calcError(problem, kNoise);
  const Problem clean = makeProblem(kSamples, 5, 0.0);
  problem.replicates = kReplicates;
  problem.parameters = clean.parameters.replicate(1, kReplicates).eval();
  problem.features = clean.features.replicate(1, kReplicates).eval();
  const RandomStream random(6, RandomPurpose::kTrainNoise);
  for (Eigen::Index i = 0; i < problem.features.cols(); ++i) {
    for (int f = 0; f < 4; ++f) {
      problem.features(f, i) += kNoise * random.calcNormal(i, f);
    }
  }
  EXPECT_LT(calcError(problem, kNoise), 1.05 * error_of_one);
}

TEST(GpMap, SearchesWithTheDrawsThatStayWithin2000Columns) {
  EXPECT_EQ(countSearchedReplicates(4 * 500, 4), 4);
  EXPECT_EQ(countSearchedReplicates(4 * 501, 4), 3);
  EXPECT_EQ(countSearchedReplicates(3 * 1000, 3), 2);
  EXPECT_EQ(countSearchedReplicates(2 * 1500, 2), 1);
  EXPECT_EQ(countSearchedReplicates(5000, 1), 1);
}

// 60 draws of 40 samples are more than 2000 columns: the last ten only enter the fit.
TEST(GpMap, IsFittedToAllDrawsAlsoWhereTheSearchUsesFewer) {
  constexpr int kSamples = 40, kReplicates = 60;
  constexpr double kNoise = 0.02;
  Problem problem = makeProblem(kSamples, 5, 0.0);
  problem.replicates = kReplicates;
  problem.parameters = problem.parameters.replicate(1, kReplicates).eval();
  problem.features = problem.features.replicate(1, kReplicates).eval();
  const RandomStream random(6, RandomPurpose::kTrainNoise);
  for (Eigen::Index i = 0; i < problem.features.cols(); ++i) {
    for (int f = 0; f < 4; ++f) {
      problem.features(f, i) += kNoise * random.calcNormal(i, f);
    }
  }
  GpMapSpec spec;
  spec.max_evaluations = 3;
  const GpMapTraining training = trainOn(problem, spec, 2);
  for (const gp::Process& process : training.map.processes) {
    EXPECT_EQ(std::get<std::shared_ptr<const gp::GaussianProcess>>(process)->getSampleCount(),
              kSamples * kReplicates);
  }
  EXPECT_EQ(training.leave_one_out.mean.cols(), kSamples * kReplicates);
}

TEST(GpMap, TheResultDoesNotDependOnTheThreads) {
  const Problem problem = makeProblem(60, 3);
  const Estimates expected = trainOn(problem).map.predict(problem.features);
  for (const int threads : {2, 3, 5}) {
    const Estimates predictions = trainOn(problem, {}, threads).map.predict(problem.features);
    EXPECT_EQ(predictions.mean, expected.mean) << threads;
    EXPECT_EQ(predictions.stddev, expected.stddev) << threads;
  }
}

TEST(GpMap, FeaturesThatSayNothingGiveAWarningAndThePriorsSpread) {
  Problem problem = makeProblem(60, 4);
  const RandomStream random(9, RandomPurpose::kTrainNoise);
  for (Eigen::Index i = 0; i < problem.features.size(); ++i) {
    problem.features.data()[i] = random.calcNormal(i, 0);
  }
  const GpMapTraining training = trainOn(problem);
  ASSERT_FALSE(training.warnings.empty());
  EXPECT_NE(training.warnings[0].find("parameter '"), std::string::npos);
  Eigen::MatrixXd unseen(4, 1);
  unseen << 0.3, -0.2, 0.1, 0.5;
  const Estimates predictions = training.map.predict(unseen);
  EXPECT_NEAR(predictions.stddev(0, 0) / training.map.target_scale[0], 1.0, 0.3);
}

// What files hold of a map is checked so: with its hyperparameters alone all else comes out again.
TEST(GpMap, IsTheSameBitForBitWhenRefittedAtItsHyperparameters) {
  GpMapSpec sparse;
  sparse.approximation = GpApproximation::kSgpr;
  sparse.inducing = 30;
  sparse.subset = 60;
  Problem problem = makeProblem(80, 1);
  problem.replicates = 2;
  problem.parameters.rightCols(40) = problem.parameters.leftCols(40).eval();
  for (const GpMapSpec& spec : {GpMapSpec{}, sparse}) {
    const GpMapTraining trained = trainOn(problem, spec);
    const TransformStepSpec z_score{ZScoreSpec{}, {}};
    const GpMapTraining again = refitGpMap(trained.map, spec, {z_score},
                                           {problem.infos,
                                            problem.features,
                                            problem.parameters,
                                            Eigen::MatrixXd::Identity(4, 4),
                                            problem.replicates,
                                            {}},
                                           2);
    EXPECT_EQ(again.leave_one_out.mean, trained.leave_one_out.mean);
    EXPECT_EQ(again.map.residual_correlation, trained.map.residual_correlation);
    const Eigen::MatrixXd features = makeProblem(50, 2).features;
    EXPECT_EQ(again.map.predict(features).mean, trained.map.predict(features).mean);
    EXPECT_EQ(again.map.predict(features).stddev, trained.map.predict(features).stddev);
    EXPECT_EQ(gp::getNlml(again.map.processes[0]), gp::getNlml(trained.map.processes[0]));
  }
}

/// One feature that mixes a parameter p in [1, 2] with an input u in [3, 5]: f = p u.
LabelledFeatures makeMixed(int samples, std::uint64_t seed) {
  LabelledFeatures mixed;
  const RandomStream random(seed, RandomPurpose::kTrainDesign);
  mixed.infos = {{"f", "", 0, 0.0}};
  mixed.features.resize(1, samples);
  mixed.parameters.resize(1, samples);
  mixed.inputs.resize(1, samples);
  mixed.noise_covariance = Eigen::MatrixXd::Constant(1, 1, 1e-6);
  for (int i = 0; i < samples; ++i) {
    mixed.parameters(0, i) = 1 + random.calcUniform(i, 0);
    mixed.inputs(0, i) = 3 + 2 * random.calcUniform(i, 1);
    mixed.features(0, i) = mixed.parameters(0, i) * mixed.inputs(0, i) + 1e-3 * random.calcNormal(i, 2);
  }
  return mixed;
}

TEST(GpMap, InfersWithKnownInputsWhatTheFeaturesAloneLeaveOpen) {
  std::vector<ParameterSpec> known(1);
  known[0].bounds = {3.0, 5.0, {}};
  const LabelledFeatures train = makeMixed(60, 1), test = makeMixed(100, 2);
  const TransformStepSpec whiten{WhitenSpec{}, {}};
  for (const LengthScales length_scales :
       {LengthScales::kShared, LengthScales::kPerOutput, LengthScales::kPerFeature}) {
    GpMapSpec spec;
    spec.length_scales = length_scales;
    const GpMapTraining training = trainGpMap(spec, {whiten}, {"p"}, train, {1}, known);
    const Estimates predictions = training.map.predict(test.features, test.inputs);
    const Eigen::ArrayXXd error = (predictions.mean - test.parameters).array();
    EXPECT_LT(std::sqrt(error.square().mean()), 1e-3);  // the noise leaves 1e-3 / u = 2.5e-4
    EXPECT_THROW(training.map.predict(test.features), std::invalid_argument);
    const GpMapTraining again = refitGpMap(training.map, spec, {whiten}, train, 1, known);
    EXPECT_EQ(again.map.predict(test.features, test.inputs).stddev, predictions.stddev);
    EXPECT_EQ(training.map.makeProcessInputs(test.features, test.inputs).row(1),
              Eigen::RowVectorXd(test.inputs.array() - 4.0));
  }
}

TEST(GpMapTraining, EndsWhereItIsAskedTo) {
  const Problem problem = makeProblem(60, 3);
  const TransformStepSpec z_score{ZScoreSpec{}, {}};
  const LabelledFeatures samples{problem.infos,      problem.features,
                                 problem.parameters, Eigen::MatrixXd::Identity(4, 4),
                                 problem.replicates, {}};
  std::atomic<bool> stop{true};
  for (const GpApproximation approximation : {GpApproximation::kExact, GpApproximation::kSgpr}) {
    GpMapSpec spec;
    spec.approximation = approximation;
    EXPECT_THROW((void)trainGpMap(spec, {z_score}, problem.names, samples, {1, &stop}), gp::Stopped);
  }
}

}  // namespace
}  // namespace twinmap
