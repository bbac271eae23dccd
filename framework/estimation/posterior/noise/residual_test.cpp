#include "framework/estimation/posterior/noise/residual_test.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>

#include "framework/estimation/levels.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Neighbours alone show an autoregression of first order best, more lags what swings. The sum over ten has a
/// heavier tail than chi-square, the more so behind a fit (of 100 white samples and four coefficients 1.2 %
/// are beyond its .33 %), so that it has the smallest share of the false alarms.
struct LagTest {
  Index lags;
  double share;
};
constexpr LagTest kLagTests[] = {{1, 0.4}, {3, 0.4}, {kMostLags, 0.1}};

/// The residuals of each output's samples, in the order of time.
std::map<int, std::vector<double>> collectSamples(const VectorXd& residual,
                                                  const std::vector<FeatureInfo>& infos) {
  std::map<int, std::vector<double>> samples;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].isSample()) {
      samples[infos[i].output].push_back(residual[static_cast<Index>(i)]);
    }
  }
  return samples;
}

/// Of residuals so many samples apart.
double calcCorrelation(const std::vector<double>& values, Index lag) {
  const Eigen::Map<const VectorXd> r(values.data(), static_cast<Index>(values.size()));
  return r.head(r.size() - lag).dot(r.tail(r.size() - lag)) / r.squaredNorm();
}

/// n (n + 2) sum_k rho_k^2 / (n - k) over the lags: chi-square of as many degrees for white noise.
double calcLjungBox(const std::vector<double>& values, Index lags) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (Index k = 1; k <= lags; ++k) {
    const double correlation = calcCorrelation(values, k);
    sum += correlation * correlation / (n - static_cast<double>(k));
  }
  return n * (n + 2.0) * sum;
}

double calcUpperTail(double chi_square, double degrees) {
  return cdf(complement(boost::math::chi_squared(degrees), chi_square));
}

/// Over so many lags of each output.
double testWhiteness(const std::map<int, std::vector<double>>& samples, Index lags) {
  double statistic = 0.0, degrees = 0.0;
  for (const auto& [output, values] : samples) {
    const auto count = static_cast<Index>(values.size());
    if (count >= kFewestTested) {
      const Index own = std::min(lags, count / kPerUnknown);
      statistic += calcLjungBox(values, own);
      degrees += static_cast<double>(own);
    }
  }
  return degrees > 0.0 && std::isfinite(statistic) ? calcUpperTail(statistic, degrees) : 1.0;
}

/// Where samples depend most on each other, in standard deviations of a correlation by chance.
void findDependence(const std::map<int, std::vector<double>>& samples, ResidualTest& test) {
  double strongest = 0.0;
  for (const auto& [output, values] : samples) {
    const auto count = static_cast<Index>(values.size());
    for (Index lag = 1; count >= kFewestTested && lag <= std::min(kMostLags, count / kPerUnknown); ++lag) {
      const double correlation = calcCorrelation(values, lag);
      const double deviations = std::abs(correlation) * std::sqrt(static_cast<double>(count));
      if (deviations > strongest) {
        strongest = deviations;
        test.output = output;
        test.lag = static_cast<int>(lag);
        test.correlation = correlation;
      }
    }
  }
}

/// By Bonferroni's bound.
double testWhiteness(const std::map<int, std::vector<double>>& samples) {
  double smallest = 1.0;
  for (const auto& [lags, share] : kLagTests) {
    smallest = std::min(smallest, testWhiteness(samples, lags) / share);
  }
  return smallest;
}

}  // namespace

double ResidualTest::calcPValue() const {
  const auto tests = {chi_square_p, whiteness_p, largest_p};
  return std::min(1.0, static_cast<double>(tests.size()) * std::min(tests));
}

bool ResidualTest::isPlausible() const {
  return calcPValue() >= kMismatchLevel && 1.0 - chi_square_p >= kRareLevel;
}

ResidualTest testResidual(const VectorXd& residual, double degrees, const std::vector<FeatureInfo>& infos) {
  ResidualTest test;
  if (residual.size() == 0) {  // all were outliers
    test.chi_square_p = 0.0;
    return test;
  }
  test.chi_square_p = calcUpperTail(residual.squaredNorm(), degrees);
  // what is left of a measurement without noise is the integration's error: below a hundredth of the noise
  // it moves no parameter by more than a seventh of its standard deviation, were it the same in 200 samples
  constexpr double kNegligible = 1e-4;  // of chi-square
  if (!(residual.squaredNorm() < kNegligible * degrees)) {
    const std::map<int, std::vector<double>> samples = collectSamples(residual, infos);
    test.whiteness_p = testWhiteness(samples);
    findDependence(samples, test);
  }
  Index largest = 0;
  const double size = residual.cwiseAbs().maxCoeff(&largest);
  test.largest = static_cast<int>(largest);
  const double outside = 2.0 * cdf(complement(boost::math::normal(), size));
  // 1 - (1 - outside)^n without cancellation
  test.largest_p = -std::expm1(static_cast<double>(residual.size()) * std::log1p(-outside));
  return test;
}

}  // namespace twinmap
