#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/gp/optimizer.hpp"
#include "kernels/gp/training_options.hpp"
#include "kernels/gp/training_set.hpp"

namespace twinmap::gp {

/// Scales of the data to which bounds and starts refer.
struct DataScales {
  double median_distance = 1.0;     ///< between samples, over all features
  Eigen::VectorXd group_distances;  ///< the same within each group's features, times sqrt(G)
  double root_mean_square = 1.0;    ///< distance of the inputs from their mean
};

/// Medians over the pairs of at most 128 evenly spaced samples. Throws std::invalid_argument if all inputs
/// are equal. A group of constant features takes the overall median.
DataScales calcDataScales(const TrainingSet& set);

SearchBox makeSearchBox(const TrainingSet& set, const DataScales& scales, double target_stddev,
                        const TrainingOptions& options);

/// The log-hyperparameters of the first `count` starts: the median distance with start_noise, then spread
/// deterministically over length scales of 0.3 to 10 medians and noise of 0.03 to 0.7.
std::vector<Eigen::VectorXd> makeStarts(const TrainingSet& set, const DataScales& scales,
                                        double target_stddev, const TrainingOptions& options, int count);

/// The least NLML of a target that is pure noise about the mean function:
///   RSS / (2 s^2) + (n - p) log s + 1/2 log|H H'| + (n - p)/2 log(2 pi),   s^2 = RSS / (n - p).
double calcNoiseOnlyNlml(const TrainingSet& set, const Eigen::VectorXd& target);

/// Whether a fit has found no signal: it gains less than 5 nats on pure noise. The best of many length scales
/// gains two or four by chance, and a true signal gains of the order of n. Also true for NaN.
bool isNoiseOnly(double nlml, double noise_only_nlml);

}  // namespace twinmap::gp
