// Hot loops must not touch the heap. This program replaces malloc's entry points by counting ones, which
// sanitizers do themselves: under them the tests are skipped.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/online/online_predictor.hpp"
#include "kernels/gp/sparse/compression.hpp"
#include "kernels/network/predictor.hpp"
#include "tests/kernels/support/random_data.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TWINMAP_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define TWINMAP_SANITIZED 1
#endif
#endif

namespace {
std::atomic<long> allocation_count{0};
}

#ifndef TWINMAP_SANITIZED
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++allocation_count;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocation_count;
  return __libc_calloc(count, size);
}
void* realloc(void* pointer, std::size_t size) {
  ++allocation_count;
  return __libc_realloc(pointer, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocation_count;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class NoAllocation : public testing::Test {
 protected:
  void SetUp() override {
#ifdef TWINMAP_SANITIZED
    GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  }
};

template <typename Action>
long allocationsOf(const Action& action) {
  const long before = allocation_count;
  action();
  return allocation_count - before;
}

TEST_F(NoAllocation, TheCounterCounts) {
  EXPECT_GT(allocationsOf([] { VectorXd::Zero(1000).eval(); }), 0);
}

TEST_F(NoAllocation, InAnEvaluationOfTheLikelihoodAndItsGradient) {
  const MatrixXd inputs = test::randomMatrix(20, 300, 1);
  const VectorXd target = test::smoothTarget(inputs, 0.1, 2);
  for (auto covariance : {CovarianceFunction::kSquaredExponential, CovarianceFunction::kMatern32,
                          CovarianceFunction::kMatern52, CovarianceFunction::kRationalQuadratic}) {
    for (auto mean : {MeanFunction::kZero, MeanFunction::kConstant, MeanFunction::kLinear}) {
      for (int groups : {1, 3, 20}) {
        const ModelStructure structure{covariance, test::cyclicGroups(20, groups), groups == 3, mean};
        const TrainingSet set(inputs, structure);
        LikelihoodWorkspace workspace(set);
        Hyperparameters hyperparameters;
        hyperparameters.length_scales = VectorXd::Constant(groups, 3.0);
        VectorXd gradient(HyperparameterLayout(structure).count);
        EXPECT_EQ(allocationsOf(
                      [&] { evaluateLikelihoodGradient(set, target, hyperparameters, workspace, gradient); }),
                  0)
            << toString(covariance) << " groups " << groups << " mean " << static_cast<int>(mean);
      }
    }
  }
}

TEST_F(NoAllocation, InAnOnlinePrediction) {
  const MatrixXd inputs = test::randomMatrix(20, 300, 1);
  const VectorXd target = test::smoothTarget(inputs, 0.1, 2);
  for (auto mean : {MeanFunction::kZero, MeanFunction::kConstant, MeanFunction::kLinear}) {
    for (int groups : {1, 20}) {
      for (bool linear_term : {false, true}) {
        const ModelStructure structure{CovarianceFunction::kMatern52, test::cyclicGroups(20, groups),
                                       linear_term, mean};
        Hyperparameters hyperparameters;
        hyperparameters.length_scales = VectorXd::Constant(groups, 3.0);
        const auto gp = fit(inputs, target, structure, hyperparameters);
        const OnlinePredictor predictor({gp, gp});
        OnlinePredictor::Workspace workspace(predictor);
        const VectorXd x = inputs.col(3);
        EXPECT_EQ(allocationsOf([&] { predictor.predictWithGradient(x, workspace); }), 0);
      }
    }
  }
}

TEST_F(NoAllocation, InAnOnlinePredictionOfCompactProcesses) {
  const MatrixXd inputs = test::randomMatrix(3, 300, 1);
  Hyperparameters hyperparameters;
  hyperparameters.length_scales = VectorXd::Constant(1, 2.0);
  const auto compact = compress(*fit(inputs, test::smoothTarget(inputs, 0.1, 2), {}, hyperparameters), 1e-3);
  ASSERT_TRUE(compact);
  const OnlinePredictor predictor({compact, compact});
  OnlinePredictor::Workspace workspace(predictor);
  const VectorXd x = inputs.col(3);
  EXPECT_EQ(allocationsOf([&] { predictor.predictWithGradient(x, workspace); }), 0);
}

TEST_F(NoAllocation, InAnOnlinePredictionOfANetwork) {
  const MatrixXd inputs = test::randomMatrix(20, 300, 1), targets = test::randomMatrix(4, 300, 2);
  const network::Predictor predictor(
      network::makeNetwork(inputs, targets, {{64, 64}, 1e-3, {5, 3}},
                           [](Eigen::Index i) { return static_cast<double>(i % 7) - 3.0; }));
  network::Predictor::Workspace workspace(predictor);
  const VectorXd x = inputs.col(3);
  EXPECT_EQ(allocationsOf([&] { predictor.predict(x, workspace); }), 0);
}

}  // namespace
}  // namespace twinmap::gp
