#include "kernels/linalg/autoregressive_whitener.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kernels/linalg/autocorrelation.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const std::vector<long> kLags{0, 1, 2, 3, 7, 8, 20, 21, 22};  // samples are missing

VectorXd makeCoefficients(std::initializer_list<double> values) {
  VectorXd made(static_cast<Index>(values.size()));
  std::copy(values.begin(), values.end(), made.begin());
  return made;
}

MatrixXd makeCorrelation(const VectorXd& a) {
  const VectorXd rho = calcAutocorrelation(std::vector<double>(a.begin(), a.end()), kLags.back());
  const auto n = static_cast<Index>(kLags.size());
  return MatrixXd::NullaryExpr(n, n, [&](Index i, Index j) {
    return rho[std::abs(kLags[static_cast<std::size_t>(i)] - kLags[static_cast<std::size_t>(j)])];
  });
}

TEST(AutoregressiveWhitener, IsTheInverseCholeskyFactorOfTheCorrelation) {
  for (const VectorXd& a :
       {makeCoefficients({0.9}), makeCoefficients({1.2, -0.5}), makeCoefficients({0.5, 0.1, -0.3})}) {
    const MatrixXd correlation = makeCorrelation(a);
    const Eigen::LLT<MatrixXd> factor(correlation);
    const AutoregressiveWhitener whitener(a, kLags);
    MatrixXd series = MatrixXd::Identity(correlation.rows(), correlation.rows());
    whitener.apply(series);  // of unit pulses, one a row
    const MatrixXd expected =
        factor.matrixL().solve(MatrixXd::Identity(correlation.rows(), correlation.rows()));
    EXPECT_LT((series.transpose() - expected).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(whitener.getLogDeterminant(), 2.0 * MatrixXd(factor.matrixL()).diagonal().array().log().sum(),
                1e-12);
  }
}

TEST(AutoregressiveWhitener, PartialAutocorrelationsGiveStationaryAutoregressions) {
  const VectorXd a = makeAutoregression(makeCoefficients({0.5, -0.8, 0.3}));
  ASSERT_TRUE(isStationary(std::vector<double>(a.begin(), a.end())));
  EXPECT_EQ(a[2], 0.3);  // the last is the partial autocorrelation
  const VectorXd rho = calcAutocorrelation(std::vector<double>(a.begin(), a.end()), 1);
  EXPECT_NEAR(rho[1], 0.5, 1e-12);  // and the first is the autocorrelation at lag one
}

}  // namespace
}  // namespace twinmap
