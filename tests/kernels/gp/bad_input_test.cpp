#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/online/online_predictor.hpp"
#include "kernels/gp/training.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The message of the std::invalid_argument that `action` throws; empty if it throws none.
template <typename Action>
std::string messageOf(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

class BadInput : public testing::Test {
 protected:
  std::string trainMessage(const ModelStructure& structure = {}, const TrainingOptions& options = {}) const {
    return messageOf([&] { (void)train(inputs_, targets_, structure, options); });
  }
  void expectFinite(const TrainingResult& result) const {
    ASSERT_TRUE(result.gp) << result.message;
    const Prediction prediction = result.gp->predict(inputs_);
    EXPECT_TRUE(prediction.mean.allFinite() && prediction.variance.allFinite());
    EXPECT_TRUE(std::isfinite(result.report.condition));
  }
  MatrixXd inputs_ = randomMatrix(3, 30, 1);
  MatrixXd targets_ = test::smoothTarget(inputs_, 0.1, 2).transpose();
};

TEST_F(BadInput, NotANumberNamesItsPlace) {
  inputs_(2, 7) = kNan;
  EXPECT_EQ(trainMessage(), "training inputs: row 2 of sample 7 is nan; every value must be finite");
  inputs_(2, 7) = 0.0;
  targets_(0, 5) = kInfinity;
  EXPECT_EQ(trainMessage(), "train: targets: row 0 of sample 5 is inf; every value must be finite");
}

TEST_F(BadInput, SizesThatDoNotFit) {
  EXPECT_NE(messageOf([&] { (void)train(inputs_, targets_.leftCols(29), {}); }).find("29 columns for 30"),
            std::string::npos);
  ModelStructure structure;
  structure.length_scale_groups = {0, 1};
  EXPECT_NE(trainMessage(structure).find("2 entries for 3 features"), std::string::npos);
  structure.length_scale_groups = {0, 2, 2};
  EXPECT_NE(trainMessage(structure).find("never uses group 1"), std::string::npos);
  structure.length_scale_groups = {0, -1, 0};
  EXPECT_NE(trainMessage(structure).find("[1] is -1"), std::string::npos);
}

TEST_F(BadInput, TooFewSamples) {
  inputs_ = inputs_.leftCols(1).eval();
  targets_ = targets_.leftCols(1).eval();
  EXPECT_NE(trainMessage().find("at least 2"), std::string::npos);
  ModelStructure structure;
  structure.mean = MeanFunction::kLinear;
  EXPECT_NE(trainMessage(structure).find("at least 5"), std::string::npos);
}

TEST_F(BadInput, TwoSamplesAreEnough) {
  inputs_ = inputs_.leftCols(2).eval();
  targets_ = targets_.leftCols(2).eval();
  expectFinite(train(inputs_, targets_, {})[0]);
}

TEST_F(BadInput, EqualInputs) {
  inputs_.setConstant(4.2);
  EXPECT_NE(trainMessage().find("all equal"), std::string::npos);
}

TEST_F(BadInput, AConstantFeatureDoesNoHarm) {
  inputs_.row(1).setConstant(-3.0);
  ModelStructure structure;
  expectFinite(train(inputs_, targets_, structure)[0]);
  structure.length_scale_groups = oneGroupPerFeature(3);
  expectFinite(train(inputs_, targets_, structure)[0]);
  structure.mean = MeanFunction::kLinear;
  EXPECT_NE(trainMessage(structure).find("linearly independent"), std::string::npos);
}

TEST_F(BadInput, DuplicatePointsDoNoHarm) {
  inputs_.rightCols(15) = inputs_.leftCols(15).eval();
  targets_.rightCols(15) = targets_.leftCols(15).eval();
  expectFinite(train(inputs_, targets_, {})[0]);
}

TEST_F(BadInput, AConstantTargetIsAStatusAndDoesNotShiftTheOthers) {
  MatrixXd both(2, 30);
  both << MatrixXd::Constant(1, 30, 7.0), targets_;
  const auto results = train(inputs_, both, {});
  EXPECT_EQ(results[0].status, TrainingStatus::kConstantTarget);
  EXPECT_FALSE(results[0].gp);
  EXPECT_EQ(results[1].gp->getAlpha(), train(inputs_, targets_, {})[0].gp->getAlpha());
}

TEST_F(BadInput, ExtremeUnitsDoNoHarm) {
  inputs_ *= 1e-9;
  targets_ *= 1e12;
  expectFinite(train(inputs_, targets_, {})[0]);
}

TEST_F(BadInput, OptionsOutOfRange) {
  TrainingOptions options;
  options.noise_stddev = {1.0, 0.5};
  EXPECT_NE(trainMessage({}, options).find("noise_stddev is [1, 0.5]"), std::string::npos);
  options = {};
  options.threads = 0;
  EXPECT_NE(trainMessage({}, options).find("threads"), std::string::npos);
  options = {};
  options.starts = 0;
  EXPECT_NE(trainMessage({}, options).find("starts"), std::string::npos);
}

TEST_F(BadInput, HyperparametersThatAreNotPositiveAndFinite) {
  Hyperparameters hyperparameters;
  hyperparameters.length_scales = VectorXd::Ones(1);
  const auto fit_message = [&] {
    return messageOf([&] { (void)fit(inputs_, targets_.row(0).transpose(), {}, hyperparameters); });
  };
  EXPECT_EQ(fit_message(), "");
  hyperparameters.noise_stddev = kNan;
  EXPECT_NE(fit_message().find("noise_stddev is nan"), std::string::npos);
  hyperparameters.noise_stddev = 0.1;
  hyperparameters.length_scales(0) = -1.0;
  EXPECT_NE(fit_message().find("length_scale[0] is -1"), std::string::npos);
  hyperparameters.length_scales = VectorXd::Ones(2);
  EXPECT_NE(fit_message().find("2 length scales"), std::string::npos);
}

TEST_F(BadInput, PredictionAtPointsThatDoNotFit) {
  const auto gp = train(inputs_, targets_, {})[0].gp;
  EXPECT_NE(messageOf([&] { (void)gp->predict(MatrixXd::Zero(2, 1)); }).find("2 features"),
            std::string::npos);
  EXPECT_NE(messageOf([&] { (void)gp->predict(MatrixXd::Constant(3, 1, kNan)); }).find("nan"),
            std::string::npos);
  EXPECT_EQ(gp->predict(MatrixXd::Zero(3, 0)).mean.size(), 0);
}

TEST_F(BadInput, AnOnlinePredictorOfNothing) {
  const std::vector<Process> none, null(1);
  EXPECT_NE(messageOf([&] { OnlinePredictor predictor(none); }), "");
  EXPECT_NE(messageOf([&] { OnlinePredictor predictor(null); }).find("null"), std::string::npos);
}

TEST_F(BadInput, PartsThatDoNotFitEachOther) {
  const GaussianProcessParts good = train(inputs_, targets_, {})[0].gp->getParts();
  GaussianProcessParts parts = good;
  parts.alpha.conservativeResize(29);
  EXPECT_NE(messageOf([&] { GaussianProcess gp(parts); }).find("alpha"), std::string::npos);
  parts = good;
  parts.factor(3, 3) = kNan;
  EXPECT_NE(messageOf([&] { GaussianProcess gp(parts); }).find("finite"), std::string::npos);
  parts = good;
  parts.mean_coefficients.resize(0);
  EXPECT_NE(messageOf([&] { GaussianProcess gp(parts); }).find("mean"), std::string::npos);
}

}  // namespace
}  // namespace twinmap::gp
