#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace twinmap {

/// A mixture of c normal distributions of p parameters: several values that may fit. No components where
/// there is no mixture.
struct Mixture {
  Eigen::VectorXd weights;                    ///< c, positive, with the sum 1
  Eigen::MatrixXd means, stddevs;             ///< p x c, in the parameters' units
  std::vector<Eigen::MatrixXd> correlations;  ///< c of p x p

  bool isGiven() const { return weights.size() > 0; }
  Eigen::Index countComponents() const { return weights.size(); }
};

/// Mean (p) and covariance (p x p) of the mixture as a whole.
Eigen::VectorXd calcMean(const Mixture& mixture);
Eigen::MatrixXd calcCovariance(const Mixture& mixture);

/// In other units: means become center + unit * means, standard deviations those times unit * stddev_scale (p
/// each).
void convert(const Eigen::VectorXd& center, const Eigen::VectorXd& unit, const Eigen::VectorXd& stddev_scale,
             Mixture& mixture);

/// A mixture that knows less of a parameter than its bounds do, being wider (standard deviation) than their
/// half width, is drawn towards their center until it is as wide. stddev (p): of the mixture as a whole.
void shrinkToBounds(const Eigen::VectorXd& center, const Eigen::VectorXd& half_width,
                    const Eigen::VectorXd& stddev, Mixture& mixture);

/// The mixture of the first p of its parameters.
Mixture takeFirst(const Mixture& mixture, Eigen::Index p);

/// The component at whose mean the density is highest: one answer that fits.
Eigen::Index findLikeliest(const Mixture& mixture);

/// The joint density of a mixture, made ready for many points. What it is made of must outlive it.
class MixtureDensity {
 public:
  explicit MixtureDensity(const Mixture& mixture);

  /// Its logarithm at a point (p). Cost: p^2 flops a component.
  double calcLog(const Eigen::Ref<const Eigen::VectorXd>& point) const;

 private:
  const Mixture& mixture_;
  std::vector<Eigen::MatrixXd> factors_;  // Cholesky, of the covariances
  Eigen::VectorXd offsets_;               // log densities at the means
};

/// One parameter's distribution.
struct MarginalMixture {
  Eigen::ArrayXd weights, means, stddevs;  ///< c

  double calcDensity(double value) const;
  double calcProbability(double value) const;  ///< of lying below
};

MarginalMixture takeMarginal(const Mixture& mixture, Eigen::Index parameter);

std::vector<MarginalMixture> takeMarginals(const std::vector<Mixture>& mixtures, Eigen::Index parameter);

/// Intervals of values, ascending.
using Intervals = std::vector<std::pair<double, double>>;

/// Where the density is above a level > 0, to some 1e-12 of a standard deviation. Peaks that are narrower
/// than a tenth of their component's standard deviation cannot be. Cost: some 200 densities a component.
Intervals findAbove(const MarginalMixture& marginal, double level);

/// The smallest set of values of the given probability, in (0, 1): where the density is highest. Of one
/// normal distribution its mean +- so many standard deviations. Cost: some 0.2 ms.
Intervals findHighestDensity(const MarginalMixture& marginal, double probability);

/// The same of the probability that a normal distribution has within so many standard deviations.
Intervals findWithin(const MarginalMixture& marginal, double depth);

/// Whether the smallest set of 95 %, or that of some parameter, is several intervals: answers that lie apart.
bool isMultimodal(const MarginalMixture& marginal);
bool isMultimodal(const Mixture& mixture);

/// The probability of the smallest highest-density set that contains the value: uniform on [0, 1] for true
/// values where the distributions are calibrated.
double calcCredibility(const MarginalMixture& marginal, double value);

/// The number of standard deviations that a normal distribution's interval of that probability has on either
/// side: its absolute z.
double calcDepth(const MarginalMixture& marginal, double value);

/// Continuous ranked probability score (Grimit et al., QJRMS 132, 2006, eq. 5), in the parameter's unit.
double calcCrps(const MarginalMixture& marginal, double truth);

}  // namespace twinmap
