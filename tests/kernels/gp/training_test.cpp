#include "kernels/gp/training.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/gp/fit.hpp"
#include "tests/kernels/support/random_data.hpp"
#include "tests/kernels/support/two_beam_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

MatrixXd twoTargets(const MatrixXd& inputs) {
  MatrixXd targets(2, inputs.cols());
  targets.row(0) = test::smoothTarget(inputs, 0.1, 21).transpose();
  targets.row(1) = 3.0 + inputs.row(2).array() * inputs.row(0).array();
  return targets;
}

TEST(Training, RecoversTheHyperparametersOfADrawnFunction) {
  const int n = 300;
  const MatrixXd inputs = 3.0 * randomMatrix(2, n, 1);
  ModelStructure structure;
  structure.mean = MeanFunction::kZero;
  const Hyperparameters truth{VectorXd::Constant(1, 1.0), 2.0, 0.3, 1.0, 1.0};
  // A draw: L times normal numbers (twelve uniform ones summed), L from any target.
  const auto prior = fit(inputs, VectorXd::Zero(n), structure, truth);
  VectorXd normal = VectorXd::Zero(n);
  for (int k = 0; k < 12; ++k) {
    normal += 0.5 * randomMatrix(n, 1, 100 + k);
  }
  const VectorXd target = prior->getFactor() * normal;
  const auto results = train(inputs, target.transpose(), structure);
  ASSERT_EQ(results[0].status, TrainingStatus::kConverged) << results[0].message;
  const Hyperparameters& found = results[0].gp->getHyperparameters();
  EXPECT_NEAR(found.length_scales(0), 1.0, 0.15);
  EXPECT_NEAR(found.noise_stddev, 0.3, 0.06);
  EXPECT_NEAR(found.signal_stddev, 2.0, 1.0);
}

TEST(Training, EndsWhereTheGradientVanishes) {
  const MatrixXd inputs = randomMatrix(4, 80, 2);
  const VectorXd target = test::smoothTarget(inputs, 0.2, 3);
  const auto result = train(inputs, target.transpose(), {})[0];
  ASSERT_TRUE(result.gp);
  const TrainingSet set(inputs, {});
  LikelihoodWorkspace workspace(set);
  VectorXd gradient(3);
  evaluateLikelihoodGradient(set, target, result.gp->getHyperparameters(), workspace, gradient);
  EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_EQ(workspace.corrections.allFinite(), true);
}

void expectEqual(const TrainingResult& one, const TrainingResult& other) {
  ASSERT_TRUE(one.gp && other.gp);
  EXPECT_EQ(one.gp->getAlpha(), other.gp->getAlpha());
  EXPECT_EQ(one.gp->getFactor(), other.gp->getFactor());
  EXPECT_EQ(one.gp->getNlml(), other.gp->getNlml());
  EXPECT_EQ(one.gp->getHyperparameters().length_scales, other.gp->getHyperparameters().length_scales);
  EXPECT_EQ(one.report.condition, other.report.condition);
  ASSERT_EQ(one.report.starts.size(), other.report.starts.size());
  for (std::size_t k = 0; k < one.report.starts.size(); ++k) {
    EXPECT_EQ(one.report.starts[k].nlml, other.report.starts[k].nlml);
    EXPECT_EQ(one.report.starts[k].evaluations, other.report.starts[k].evaluations);
  }
}

TEST(Training, IsBitwiseTheSameForAnyNumberOfThreadsAndAlignment) {
  const MatrixXd inputs = randomMatrix(6, 90, 4);
  const MatrixXd targets = twoTargets(inputs);
  for (int groups : {1, 2, 6}) {
    ModelStructure structure;
    structure.length_scale_groups = test::cyclicGroups(6, groups);
    TrainingOptions options;
    const auto expected = train(inputs, targets, structure, options);
    for (int threads : {2, 3, 5}) {
      options.threads = threads;
      // The same numbers at another address: one double off the previous alignment.
      std::vector<double> moved(inputs.size() + 8);
      Eigen::Map<MatrixXd> shifted(moved.data() + threads, inputs.rows(), inputs.cols());
      shifted = inputs;
      const auto actual = train(shifted, targets, structure, options);
      for (std::size_t t = 0; t < 2; ++t) {
        expectEqual(expected[t], actual[t]);
      }
    }
  }
}

// Large matrices are factorised by a team; the smallest that is checked here spans several strips of it.
TEST(Likelihood, IsBitwiseTheSameForAnySizeOfTheTeam) {
  const int n = 1100;
  const MatrixXd inputs = randomMatrix(6, n, 30);
  const VectorXd target = test::smoothTarget(inputs, 0.1, 31);
  for (int groups : {1, 6}) {
    const ModelStructure structure{CovarianceFunction::kMatern52, test::cyclicGroups(6, groups), false,
                                   MeanFunction::kLinear};
    const TrainingSet set(inputs, structure);
    const Hyperparameters hyperparameters{VectorXd::Constant(groups, 1.5), 1.0, 0.1, 1.0, 1.0};
    LikelihoodWorkspace alone(set);
    VectorXd expected(groups + 2), gradient(groups + 2);
    const double nlml = evaluateLikelihoodGradient(set, target, hyperparameters, alone, expected).nlml;
    for (int threads : {2, 3, 5}) {
      LikelihoodWorkspace team(set, threads);
      EXPECT_EQ(evaluateLikelihoodGradient(set, target, hyperparameters, team, gradient).nlml, nlml);
      EXPECT_EQ(gradient, expected);
      EXPECT_EQ(team.corrections, alone.corrections);
    }
  }
}

TEST(Training, RecognisesPureNoise) {
  const MatrixXd inputs = randomMatrix(3, 100, 5);
  const MatrixXd noise = randomMatrix(1, 100, 6);
  const auto result = train(inputs, noise, {})[0];
  EXPECT_EQ(result.status, TrainingStatus::kNoiseOnly) << result.message;
  for (const StartReport& start : result.report.starts) {
    EXPECT_TRUE(start.noise_only);
  }
  ASSERT_TRUE(result.gp);
  const Prediction prediction = result.gp->predict(randomMatrix(3, 1, 16));
  const double stddev = std::sqrt((noise.array() - noise.mean()).square().mean());
  EXPECT_NEAR(prediction.stddev()(0), stddev, 0.1 * stddev);
}

TEST(Training, DoesNotAcceptAStartThatEndsInPureNoise) {
  const MatrixXd inputs = randomMatrix(5, 60, 7);
  const VectorXd target = test::smoothTarget(inputs, 0.4, 8);
  const auto result = train(inputs, target.transpose(), {})[0];
  ASSERT_GE(result.report.best_start, 0);
  const StartReport& best = result.report.starts[result.report.best_start];
  EXPECT_FALSE(best.noise_only);
  EXPECT_LT(best.nlml, result.report.noise_only_nlml);
  for (const StartReport& start : result.report.starts) {
    EXPECT_LE(best.nlml, start.nlml);
  }
}

TEST(Training, ReportsWhatSitsAtABound) {
  const MatrixXd inputs = randomMatrix(2, 50, 9);
  const VectorXd target = inputs.row(0).transpose();  // exactly linear and noise-free
  const auto result = train(inputs, target.transpose(), {})[0];
  ASSERT_TRUE(result.gp);
  ASSERT_FALSE(result.report.at_bound.empty());
  EXPECT_TRUE(result.gp->predict(inputs).mean.isApprox(target, 1e-3));
}

TEST(Training, APriorDrawsTheLengthScaleTowardsIt) {
  const MatrixXd inputs = randomMatrix(2, 40, 10);
  const VectorXd target = test::smoothTarget(inputs, 0.1, 11);
  TrainingOptions options;
  const double free =
      train(inputs, target.transpose(), {}, options)[0].gp->getHyperparameters().length_scales(0);
  options.length_scale_prior = LengthScalePrior{2.0, 0.01};
  const double bound =
      train(inputs, target.transpose(), {}, options)[0].gp->getHyperparameters().length_scales(0);
  EXPECT_GT(bound, 1.5 * free);
}

TEST(Training, OneLengthScalePerFeatureFindsTheFeaturesThatMatter) {
  const MatrixXd inputs = randomMatrix(6, 120, 12);
  const VectorXd target = test::smoothTarget(inputs, 0.05, 13);  // of features 0 and 1
  ModelStructure structure;
  structure.length_scale_groups = oneGroupPerFeature(6);
  const auto result = train(inputs, target.transpose(), structure)[0];
  ASSERT_EQ(result.status, TrainingStatus::kConverged);
  const VectorXd scales = result.gp->getHyperparameters().length_scales;
  EXPECT_GT(scales.tail(4).minCoeff(), 2.0 * scales.head(2).maxCoeff());
}

TEST(Training, ARestoredProcessPredictsTheSameBits) {
  const MatrixXd inputs = randomMatrix(3, 50, 14);
  const auto result = train(inputs, twoTargets(inputs), {})[1];
  GaussianProcessParts parts = result.gp->getParts();
  parts.inputs = std::make_shared<const MatrixXd>(inputs);
  const GaussianProcess restored(parts);
  const MatrixXd tests = randomMatrix(3, 300, 15);
  EXPECT_EQ(restored.predict(tests).mean, result.gp->predict(tests).mean);
  EXPECT_EQ(restored.predict(tests).variance, result.gp->predict(tests).variance);
}

// Whatever the first start, the same best likelihood. (Single searches reach it from 62 of the 64 corners:
// d_y has a second optimum 0.8 nats away, which is why there are several starts.)
TEST(TwoBeams, EveryFirstStartLeadsToTheSameLikelihood) {
  const test::TwoBeamData data = test::makeTwoBeamData(250, 1);
  const MatrixXd features = test::zScored(data.features);
  MatrixXd nlml(4, 16);
  int corner = 0;
  for (double noise : {0.03, 0.1, 0.3, 0.7}) {
    for (double length : {0.3, 1.0, 3.0, 10.0}) {
      TrainingOptions options;
      options.start_noise = noise;
      options.start_length_scale = length;
      const auto results = train(features, data.parameters, {}, options);
      for (int t = 0; t < 4; ++t) {
        ASSERT_EQ(results[t].status, TrainingStatus::kConverged) << results[t].message;
        nlml(t, corner) = results[t].gp->getNlml();
      }
      ++corner;
    }
  }
  for (int t = 0; t < 4; ++t) {
    EXPECT_LT(nlml.row(t).maxCoeff() - nlml.row(t).minCoeff(), 1e-3) << t;
  }
}

}  // namespace
}  // namespace twinmap::gp
