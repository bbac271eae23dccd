#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kernels/exact/exact.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/packed_lower.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

constexpr int kScores = 12;

/// Scores in two windows, what they are of u unknowns, with what error of each, correlated.
struct Model {
  std::function<VectorXd(const VectorXd&)> calc;
  std::function<MatrixXd(const VectorXd&)> derive;
  MatrixXd training;  // u x n
  std::function<double(const VectorXd&)> calc_stddev;
  MatrixXd correlation = MatrixXd::Identity(kScores, kScores);
  VectorXd prior_mean = VectorXd::Zero(training.rows());
  MatrixXd prior_relative = MatrixXd::Identity(training.rows(), training.rows());
};

class Searching {
 public:
  Searching(Model model, const VectorXd& measured)
      : model_(std::move(model)),
        correlation_(linalg::packColumns(model_.correlation)),
        training_scores_(kScores, model_.training.cols()) {
    const int u = countUnknown();
    for (Index i = 0; i < model_.training.cols(); ++i) {
      training_scores_.col(i) = model_.calc(model_.training.col(i));
    }
    problem_.scores = kScores;
    problem_.unknown = problem_.variables = u;
    problem_.windows = 2;
    problem_.points = static_cast<int>(model_.training.cols());
    problem_.window = windows_;
    problem_.rough_weights = problem_.leading_weights = weights_.data();
    problem_.correlation = correlation_.data();
    problem_.prior_mean = model_.prior_mean.data();
    problem_.prior_relative = model_.prior_relative.data();
    problem_.training_points = model_.training.data();
    problem_.training_scores = training_scores_.data();
    problem_.evaluate = evaluate;
    problem_.calc_stddev = calcStddev;
    room_.resize(static_cast<std::size_t>(exact::countSearch(kScores, u, u, 2)));
    search_ = exact::layOutSearch(problem_, this, room_.data());
    std::copy_n(measured.data(), kScores, search_.scores);
  }
  Searching(const Searching&) = delete;
  Searching& operator=(const Searching&) = delete;

  exact::score_search& upd() { return search_; }
  const std::vector<double>& getRoom() const { return room_; }
  void refine(bool may_widen) {
    for (int i = 0; i < search_.minimum_count; ++i) {
      exact::refineMinimum(search_, i, may_widen);
    }
  }
  int mix() {
    const int u = countUnknown();
    return exact::mixMinima(search_, MatrixXd::Zero(u, u).eval().data(), VectorXd::Zero(u).eval().data());
  }
  VectorXd getMean() const { return Map<const VectorXd>(search_.mean, countUnknown()); }
  VectorXd getStddev() const {
    return Map<const MatrixXd>(search_.covariance, countUnknown(), countUnknown()).diagonal().cwiseSqrt();
  }

 private:
  int countUnknown() const { return static_cast<int>(model_.training.rows()); }

  static void evaluate(const exact::score_search* search, int window, int count) {
    const Model& model = static_cast<Searching*>(search->owner)->model_;
    const Index u = model.training.rows(), first = search->problem->window[window].first;
    const VectorXd at = Map<const VectorXd>(search->at, u);
    Map<VectorXd>(search->values + first, count) = model.calc(at).segment(first, count);
    Map<MatrixXd>(search->jacobian, kScores, u).middleRows(first, count) =
        model.derive(at).middleRows(first, count);
  }
  static void calcStddev(const exact::score_search* search, int window) {
    const Model& model = static_cast<Searching*>(search->owner)->model_;
    const exact::score_window& scores = search->problem->window[window];
    const double stddev = model.calc_stddev(Map<const VectorXd>(search->at, model.training.rows()));
    Map<VectorXd>(search->stddev + scores.first, scores.functions).setConstant(stddev);
  }

  Model model_;
  const exact::score_window windows_[2] = {{0, 5, 5}, {5, kScores - 5, kScores - 5}};
  const VectorXd weights_ = VectorXd::Ones(kScores);
  const VectorXd correlation_;
  MatrixXd training_scores_;
  exact::score_problem problem_ = {};
  std::vector<double> room_;
  exact::score_search search_ = {};
};

Model makeLinear(const MatrixXd& slopes, double stddev) {
  return {[slopes](const VectorXd& at) -> VectorXd { return slopes * at; },
          [slopes](const VectorXd&) { return slopes; }, 0.8 * randomMatrix(3, 20, 4),
          [stddev](const VectorXd&) { return stddev; }};
}

TEST(ScoreSearch, TakesTheRoomThatItCounts) {
  Searching searching(makeLinear(MatrixXd::Ones(kScores, 3), 0.0), VectorXd::Zero(kScores));
  const double* end = searching.upd().box_buffer + 3 * (3 + 3);
  EXPECT_EQ(end, searching.getRoom().data() + searching.getRoom().size());
}

TEST(ScoreSearch, GivesTheGeneralisedLeastSquaresOfALinearModel) {
  const MatrixXd slopes = 200.0 * randomMatrix(kScores, 3, 1);
  Model model = makeLinear(slopes, 0.75);
  model.correlation.setConstant(0.6);
  model.correlation.diagonal().setOnes();
  const MatrixXd covariance = MatrixXd::Identity(kScores, kScores) + 0.75 * 0.75 * model.correlation;
  const VectorXd truth = (VectorXd(3) << 0.3, -0.5, 0.1).finished();
  const VectorXd measured = slopes * truth + randomMatrix(kScores, 1, 2);
  Searching searching(model, measured);
  exact::searchFromSimulations(searching.upd());
  searching.refine(true);
  const int best = searching.mix();
  const MatrixXd weighted = linalg::invertPositiveDefinite(covariance) * slopes;
  const MatrixXd expected = linalg::invertPositiveDefinite(slopes.transpose() * weighted);
  EXPECT_LT((searching.getMean() - expected * weighted.transpose() * measured).cwiseAbs().maxCoeff(),
            1e-6);  // of sds of 0.005
  EXPECT_LT((searching.getStddev() - expected.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff(), 1e-9);
  const MatrixXd of_noise = linalg::invertPositiveDefinite(slopes.transpose() * slopes);
  const Map<const VectorXd> noise(searching.upd().noise_stddev, 3);
  EXPECT_LT((noise - of_noise.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_FALSE(searching.upd().minima[best].widened);
}

TEST(ScoreSearch, IsDrawnByACorrelatedPrior) {
  const MatrixXd slopes = 0.5 * randomMatrix(kScores, 3, 1), root = randomMatrix(3, 3, 6);
  Model model = makeLinear(slopes, 0.0);
  model.prior_relative = root * root.transpose() + 0.2 * MatrixXd::Identity(3, 3);
  model.prior_mean = (VectorXd(3) << 0.1, 0.3, -0.2).finished();
  const VectorXd measured = slopes * (VectorXd(3) << 0.2, -0.4, 0.3).finished();
  const MatrixXd prior = 3.0 * model.prior_relative;
  const VectorXd expected = linalg::solvePositiveDefinite(
      slopes.transpose() * slopes + prior, slopes.transpose() * measured + prior * model.prior_mean);
  Searching searching(model, measured);
  exact::searchFrom(searching.upd(), VectorXd::Constant(3, -0.9).eval().data());
  searching.refine(false);
  const Map<const VectorXd> found(searching.upd().minima[0].point, 3);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-3);  // the first damping is a thousandth
}

TEST(ScoreSearch, EnlargesErrorsUntilTheyExplainTheScoresOnlyWhereItMay) {
  const MatrixXd slopes = 200.0 * randomMatrix(kScores, 3, 1);
  const VectorXd measured = 30.0 * randomMatrix(kScores, 1, 2);
  Searching searching(makeLinear(slopes, 1.0), measured);
  exact::searchFromSimulations(searching.upd());
  searching.refine(false);
  EXPECT_FALSE(searching.upd().minima[exact::findLeast(searching.upd())].widened);
  exact::searchFrom(searching.upd(), VectorXd::Zero(3).eval().data());
  searching.refine(true);
  EXPECT_TRUE(searching.upd().minima[searching.mix()].widened);
  EXPECT_GT(searching.upd().widening[1], 3.0);
  const double chi_square = Map<const VectorXd>(searching.upd().residual, kScores).squaredNorm();
  EXPECT_LT(chi_square, kScores + 4.0 * std::sqrt(2.0 * kScores));
}

/// Each score is 50 x^2 + steeper x^3: two minima, where `steeper` is 0 mirrored.
Model makeParabola(double steeper, const std::function<double(const VectorXd&)>& calc_stddev) {
  return {[steeper](const VectorXd& at) -> VectorXd {
            return VectorXd::Constant(kScores, (50.0 + steeper * at(0)) * at(0) * at(0));
          },
          [steeper](const VectorXd& at) -> MatrixXd {
            return MatrixXd::Constant(kScores, 1, (100.0 + 3.0 * steeper * at(0)) * at(0));
          },
          (MatrixXd(1, 4) << -0.9, -0.4, 0.5, 0.8).finished(), calc_stddev};
}

TEST(ScoreSearch, MixesMirroredMinimaHalfAndHalf) {
  const double truth = 0.6;
  const Model square = makeParabola(0.0, [](const VectorXd&) { return 0.0; });
  Searching searching(square, square.calc(VectorXd::Constant(1, truth)));
  exact::searchFromSimulations(searching.upd());
  ASSERT_EQ(searching.upd().minimum_count, 2);
  searching.refine(true);
  searching.mix();
  EXPECT_NEAR(searching.upd().share[0], 0.5, 1e-3);
  EXPECT_NEAR(searching.upd().minima[0].point[0], -searching.upd().minima[1].point[0], 1e-3);
  EXPECT_NEAR(searching.getMean()(0), 0.0, 2e-3);
  EXPECT_NEAR(searching.getStddev()(0), truth, 5e-3);
}

TEST(ScoreSearch, SharesAreThoseOfLaplacesApproximation) {
  const auto calc_stddev = [](const VectorXd& at) { return at(0) > 0.0 ? 0.1 : 0.3; };
  const Model model = makeParabola(10.0, calc_stddev);
  const double truth = 0.5;
  Searching searching(model, model.calc(VectorXd::Constant(1, truth)));
  exact::searchFromSimulations(searching.upd());
  searching.refine(true);
  searching.mix();
  ASSERT_EQ(searching.upd().minimum_count, 2);
  // of exp(-(3 x^2 + log det C + log information) / 2) at both, the scores being explained
  const auto weigh = [&](const VectorXd& at) {
    const double variance = 1.0 + std::pow(calc_stddev(at), 2);
    const double information = model.derive(at).squaredNorm() / variance + 3.0;
    return std::exp(-0.5 * (3.0 * at(0) * at(0) + kScores * std::log(variance) + std::log(information)));
  };
  double total = 0.0;
  for (int i = 0; i < 2; ++i) {
    total += weigh(VectorXd::Constant(1, searching.upd().minima[i].point[0]));
  }
  for (int i = 0; i < 2; ++i) {
    const VectorXd at = VectorXd::Constant(1, searching.upd().minima[i].point[0]);
    EXPECT_NEAR(searching.upd().share[i], weigh(at) / total, 0.02) << at;
  }
}

TEST(ScoreSearch, MovesAStartIntoTheBoxAndStaysThere) {
  const MatrixXd slopes = 200.0 * randomMatrix(kScores, 3, 1);
  const VectorXd beyond = (VectorXd(3) << 1.4, 0.2, -0.3).finished();
  Searching searching(makeLinear(slopes, 0.0), slopes * beyond);
  exact::searchFrom(searching.upd(), beyond.data());
  searching.refine(false);
  const exact::score_minimum& found = searching.upd().minima[exact::findLeast(searching.upd())];
  EXPECT_EQ(found.point[0], 1.0);
  EXPECT_GT(Map<const VectorXd>(found.innovation, kScores).norm(), 10.0);
}

}  // namespace
}  // namespace twinmap
