#include "kernels/sampling/nuts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/network/last_layer.hpp"
#include "kernels/sampling/convergence.hpp"

namespace twinmap::markov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// On (0, 1), by the numbers' place alone (SplitMix64).
double calcUniform(std::uint64_t chain, std::uint64_t kind, Index i) {
  std::uint64_t x = (chain * 1000003 + kind) * 0x9E3779B97F4A7C15 + std::uint64_t(i) * 0xD1B54A32D192ED03;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
  return (double((x ^ (x >> 31)) >> 11) + 0.5) * 0x1p-53;
}

ChainNumbers makeNumbers(unsigned chain) {
  return {[chain](Index i) {  // Box and Muller
            return std::sqrt(-2.0 * std::log(calcUniform(chain, 1, i))) *
                   std::cos(2.0 * M_PI * calcUniform(chain, 2, i));
          },
          [chain](Index i) { return calcUniform(chain, 3, i); }};
}

/// The normal distribution of a mean and a precision.
LogDensity makeNormal(VectorXd mean, MatrixXd precision) {
  return
      [mean = std::move(mean), precision = std::move(precision)](const VectorXd& point, VectorXd& gradient) {
        gradient = -precision * (point - mean);
        return 0.5 * (point - mean).dot(gradient);
      };
}

std::vector<Chain> sampleChains(const LogDensity& density, Index dimensions, unsigned count, int draws) {
  std::vector<Chain> chains;
  for (unsigned c = 0; c < count; ++c) {
    NutsOptions options;
    options.draws = draws;
    chains.push_back(sampleNuts(density, VectorXd::Constant(dimensions, c - 1.5), makeNumbers(c), options));
  }
  return chains;
}

Convergence judge(const std::vector<Chain>& chains, Index row) {
  std::vector<VectorXd> rows;
  for (const Chain& chain : chains) {
    rows.push_back(chain.draws.row(row));
  }
  return calcConvergence(rows);
}

/// Means and covariances of all draws against those of the distribution, within 4.5 standard errors.
void expectMoments(const std::vector<Chain>& chains, const VectorXd& mean, const MatrixXd& covariance) {
  const Index n = chains.front().draws.cols(), d = mean.size();
  MatrixXd all(d, n * static_cast<Index>(chains.size()));
  for (std::size_t c = 0; c < chains.size(); ++c) {
    all.middleCols(static_cast<Index>(c) * n, n) = chains[c].draws;
    EXPECT_EQ(chains[c].divergences, 0);
    EXPECT_EQ(chains[c].cut, 0);
    // Dual averaging holds the acceptance of its own swinging steps at 0.8. Their mean logarithm, which the
    // draws use, is accepted more often, as acceptance is concave in it: over 300 chains of
    // DrawsFromANormalDistributionOfManyScales .907 with a standard deviation of .0106. 4.5 of those above.
    EXPECT_NEAR(chains[c].mean_acceptance, 0.8, 0.155);
  }
  const VectorXd found = all.rowwise().mean();
  const MatrixXd centered = all.colwise() - found;
  for (Index i = 0; i < d; ++i) {
    const Convergence convergence = judge(chains, i);
    EXPECT_LT(convergence.r_hat, 1.01);
    const double error = std::sqrt(1.0 / convergence.effective_sample_size);
    EXPECT_NEAR(found[i], mean[i], 4.5 * error * std::sqrt(covariance(i, i)));
    for (Index j = 0; j < d; ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      // squares are correlated longer than values
      EXPECT_NEAR(centered.row(i).dot(centered.row(j)) / double(all.cols()), covariance(i, j),
                  4.5 * scale * std::sqrt(2.0) * std::max(error, 0.02));
    }
  }
}

TEST(Nuts, DrawsFromANormalDistributionOfManyScales) {
  const Index d = 6;
  MatrixXd factor = MatrixXd::Identity(d, d);
  for (Index i = 0; i < d; ++i) {
    for (Index j = 0; j < i; ++j) {
      factor(i, j) = 0.3 * std::sin(1.0 + 3.0 * double(i) + double(j));
    }
    factor.row(i) *= std::pow(10.0, double(i) - 3.0);
  }
  const MatrixXd covariance = factor * factor.transpose();
  const MatrixXd precision = linalg::solveCholesky(factor, MatrixXd::Identity(d, d));
  const VectorXd mean = VectorXd::LinSpaced(d, -1.0, 1.0);
  expectMoments(sampleChains(makeNormal(mean, precision), d, 4, 1500), mean, covariance);
}

TEST(Nuts, DrawsTheWeightsOfALinearNetworkFromTheirPosterior) {
  const Index h = 3, p = 2, n = 12;
  constexpr double kAlpha = 0.7;
  network::LinearObservations observations{MatrixXd(h, n), MatrixXd(p, n), {}};
  for (Index i = 0; i < n; ++i) {
    const auto t = double(i);
    observations.inputs.col(i) << 1.0, std::sin(t), std::cos(2.0 * t);
    observations.targets.col(i) << std::sin(0.7 * t), 0.3 * t - 1.0;
    MatrixXd precision(p, p);
    precision << 2.0, 0.5, 0.5, 1.0 + 0.1 * t;
    observations.precisions.push_back(precision);
  }
  const LogDensity density = [&](const VectorXd& weights, VectorXd& gradient) {
    const MatrixXd matrix = weights.reshaped(p, h);
    MatrixXd slopes = -kAlpha * matrix;
    double logarithm = -0.5 * kAlpha * weights.squaredNorm();
    for (Index i = 0; i < n; ++i) {
      const VectorXd rest = observations.targets.col(i) - matrix * observations.inputs.col(i);
      const VectorXd weighted = observations.precisions[std::size_t(i)] * rest;
      logarithm -= 0.5 * rest.dot(weighted);
      slopes += weighted * observations.inputs.col(i).transpose();
    }
    gradient = slopes.reshaped();
    return logarithm;
  };
  const network::LastLayerPosterior posterior = network::calcLastLayerPosterior(observations, kAlpha);
  MatrixXd covariance(p * h, p * h);  // from the covariances of W f for unit vectors and their sums
  const auto calcCovariance = [&](Index a, Index b) {
    const VectorXd sum = VectorXd::Unit(h, a) + VectorXd::Unit(h, b);
    return posterior.calcCovariance(sum);
  };
  for (Index a = 0; a < h; ++a) {
    for (Index b = 0; b < h; ++b) {
      const MatrixXd own = posterior.calcCovariance(VectorXd::Unit(h, a));
      const MatrixXd other = posterior.calcCovariance(VectorXd::Unit(h, b));
      // symmetric part of the cross covariance; its diagonal is all that is compared
      covariance.block(a * p, b * p, p, p) =
          a == b ? own : MatrixXd(0.5 * (calcCovariance(a, b) - own - other));
    }
  }
  const std::vector<Chain> chains = sampleChains(density, p * h, 4, 1500);
  const VectorXd mean = posterior.mean.reshaped();
  const Index draws = chains.front().draws.cols();
  for (Index i = 0; i < p * h; ++i) {
    const Convergence convergence = judge(chains, i);
    EXPECT_LT(convergence.r_hat, 1.01);
    const double stddev = std::sqrt(covariance(i, i));
    double found = 0.0, squares = 0.0;
    for (const Chain& chain : chains) {
      found += chain.draws.row(i).sum() / double(4 * draws);
      squares += (chain.draws.row(i).array() - mean[i]).square().sum() / double(4 * draws);
    }
    EXPECT_NEAR(found, mean[i], 4.5 * stddev / std::sqrt(convergence.effective_sample_size));
    EXPECT_NEAR(std::sqrt(squares) / stddev, 1.0, 0.1);
  }
}

TEST(Nuts, GivesTheSameBitsForTheSameNumbers) {
  const LogDensity density = makeNormal(VectorXd::Zero(2), MatrixXd::Identity(2, 2));
  EXPECT_EQ(sampleNuts(density, VectorXd::Ones(2), makeNumbers(1), {}).draws,
            sampleNuts(density, VectorXd::Ones(2), makeNumbers(1), {}).draws);
}

TEST(Nuts, ReportsTrajectoriesThatRunAway) {
  // Neal's funnel: its neck is too narrow for the step that its mouth needs
  const LogDensity funnel = [](const VectorXd& point, VectorXd& gradient) {
    const double v = point[0], precision = std::exp(-v), squares = point.tail(9).squaredNorm();
    gradient[0] = -v / 9.0 - 4.5 + 0.5 * precision * squares;
    gradient.tail(9) = -precision * point.tail(9);
    return -v * v / 18.0 - 4.5 * v - 0.5 * precision * squares;
  };
  int divergences = 0;
  for (unsigned c = 0; c < 4; ++c) {
    divergences += sampleNuts(funnel, VectorXd::Constant(10, 0.5), makeNumbers(c), {}).divergences;
  }
  EXPECT_GT(divergences, 0);
}

TEST(Nuts, RefusesAStartOfNoDensityAndEndsWhenAskedTo) {
  const LogDensity impossible = [](const VectorXd&, VectorXd& gradient) {
    gradient.setZero();
    return -std::numeric_limits<double>::infinity();
  };
  EXPECT_THROW(sampleNuts(impossible, VectorXd::Zero(1), makeNumbers(1), {}), std::invalid_argument);
  const std::atomic<bool> stop{true};
  NutsOptions options;
  options.stop = &stop;
  const LogDensity density = makeNormal(VectorXd::Zero(1), MatrixXd::Identity(1, 1));
  EXPECT_THROW(sampleNuts(density, VectorXd::Zero(1), makeNumbers(1), options), gp::Stopped);
}

std::vector<VectorXd> makeAutoregressive(double memory, int chains, Index draws) {
  std::vector<VectorXd> made;
  std::mt19937_64 engine(5);
  std::normal_distribution<> normal;
  for (int c = 0; c < chains; ++c) {
    VectorXd values(draws);
    double value = normal(engine) / std::sqrt(1.0 - memory * memory);
    for (double& one : values) {
      value = memory * value + normal(engine);
      one = value;
    }
    made.push_back(values);
  }
  return made;
}

TEST(Convergence, CountsIndependentDraws) {
  const Convergence white = calcConvergence(makeAutoregressive(0.0, 4, 5000));
  EXPECT_NEAR(white.effective_sample_size / 20000.0, 1.0, 0.1);
  EXPECT_NEAR(white.r_hat, 1.0, 0.002);
  const Convergence slow = calcConvergence(makeAutoregressive(0.9, 4, 20000));
  EXPECT_NEAR(slow.effective_sample_size / (80000.0 * 0.1 / 1.9), 1.0, 0.15);
  const Convergence swinging = calcConvergence(makeAutoregressive(-0.5, 4, 20000));
  EXPECT_NEAR(swinging.effective_sample_size / (80000.0 * 1.5 / 0.5), 1.0, 0.15);
}

TEST(Convergence, SeesChainsThatDisagreeAndChainsThatDrift) {
  std::vector<VectorXd> chains = makeAutoregressive(0.0, 4, 1000);
  chains[2].array() += 1.0;
  const Convergence apart = calcConvergence(chains);
  EXPECT_GT(apart.r_hat, 1.05);
  EXPECT_LT(apart.effective_sample_size, 100.0);
  std::vector<VectorXd> drifting = makeAutoregressive(0.0, 1, 1000);
  drifting[0] += VectorXd::LinSpaced(1000, -2.0, 2.0);
  EXPECT_GT(calcConvergence(drifting).r_hat, 1.1);
}

}  // namespace
}  // namespace twinmap::markov
