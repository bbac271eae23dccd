#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "kernels/gp/optimizer.hpp"
#include "kernels/gp/sparse/sparse_training.hpp"
#include "kernels/gp/training.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rosenbrock's function, which takes a search some dozens of evaluations; `before` each of them.
Objective makeObjective(const std::function<void()>& before) {
  return [=](const VectorXd& x, VectorXd& gradient) {
    before();
    const double across = x(1) - x(0) * x(0), along = 1.0 - x(0);
    gradient = VectorXd(2);
    gradient << -400.0 * x(0) * across - 2.0 * along, 200.0 * across;
    return LikelihoodEvaluation{true, 100.0 * across * across + along * along, 0.0};
  };
}

SearchResult searchWith(const Objective& objective, StopFlag stop) {
  const SearchBox box{VectorXd::Constant(2, -5.0), VectorXd::Constant(2, 5.0), VectorXd::Zero(2),
                      VectorXd::Zero(2)};
  SearchLimits limits;
  limits.stop = stop;
  return minimize(objective, 1, VectorXd::Constant(2, -1.5), box, limits);
}

// Another thread sets the flag while the fifth evaluation is under way.
TEST(Stopping, ASearchEvaluatesNothingMore) {
  std::atomic<bool> stop{false};
  const SearchResult whole = searchWith(makeObjective([] {}), &stop);
  EXPECT_TRUE(whole.converged);
  EXPECT_NEAR(whole.nlml, 0.0, 1e-4);
  ASSERT_GT(whole.evaluations, 10);

  int calls = 0;
  const SearchResult stopped = searchWith(makeObjective([&] {
                                            if (++calls == 5) {
                                              std::thread([&] { stop = true; }).join();
                                            }
                                          }),
                                          &stop);
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(stopped.evaluations, 5);
  EXPECT_FALSE(stopped.converged);
  EXPECT_EQ(stopped.stop_reason, "asked to stop");
  EXPECT_GT(stopped.objective, whole.objective);

  EXPECT_EQ(searchWith(makeObjective([] {}), &stop).evaluations, 0);
}

struct SlowProblem {
  MatrixXd inputs = test::randomMatrix(3, 250, 1);
  MatrixXd targets = test::smoothTarget(inputs, 0.1, 2).transpose();
};

TrainingOptions makeOptions(StopFlag stop, int starts = 2) {
  TrainingOptions options;
  options.starts = starts;
  options.stop = stop;
  return options;
}

// As many starts as would take a quarter of an hour.
TEST(Stopping, TrainingEndsWhileItIsUnderWay) {
  const SlowProblem problem;
  for (const int threads : {1, 2}) {
    std::atomic<bool> stop{false};
    TrainingOptions options = makeOptions(&stop, 100000);
    options.threads = threads;
    auto training =
        std::async(std::launch::async, [&] { return train(problem.inputs, problem.targets, {}, options); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stop = true;
    EXPECT_THROW((void)training.get(), Stopped);
  }
}

TEST(Stopping, SparseTrainingEndsInEachOfItsStages) {
  const SlowProblem problem;
  std::atomic<bool> stop{true};
  EXPECT_THROW((void)trainSparse(problem.inputs, problem.targets, {}, makeOptions(&stop), {50, 100, 20}),
               Stopped);
  // One evaluation a target on the subset, then as much on the bounds as would take a minute.
  stop = false;
  TrainingOptions options = makeOptions(&stop, 1);
  options.max_evaluations = 1;
  const MatrixXd targets = problem.targets.replicate(1000, 1);
  auto training = std::async(std::launch::async, [&] {
    return trainSparse(problem.inputs, targets, {}, options, {100, 20, 200});
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  stop = true;
  EXPECT_THROW((void)training.get(), Stopped);
}

TEST(Stopping, AFlagThatIsNeverSetChangesNothing) {
  const SlowProblem problem;
  std::atomic<bool> stop{false};
  const auto watched = train(problem.inputs, problem.targets, {}, makeOptions(&stop))[0];
  const auto alone = train(problem.inputs, problem.targets, {}, makeOptions(nullptr))[0];
  EXPECT_EQ(watched.report.evaluations, alone.report.evaluations);
  EXPECT_EQ(watched.gp->getAlpha(), alone.gp->getAlpha());
}

}  // namespace
}  // namespace twinmap::gp
