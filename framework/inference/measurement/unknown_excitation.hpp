#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Samples behind which a spline has forgotten all but 1e-7.
constexpr std::size_t kSplineReach = 12;

/// So often what is unknown is counted at a fit, which it moves: the first time by much, then by little.
constexpr int kTimesCounted = 3;

/// Whether something of a measured excitation is not known: samples that were lost (TableSpec::unknown), or
/// the noise of those that are there (MeasuredSignalSpec::noise).
bool hasUnknownExcitation(const ModelSpec& model);

/// What one standard deviation of each adds to the response at a point of all parameters: rows x r, so that
/// its covariance is their product with their transpose, to first order. Noise counts in up to 500 stretches
/// of samples, each as one of their mean: a response does not tell what is faster. Columns are
/// 0 where nothing can be simulated, without where nothing can be at all. Cost: r + 1 simulations.
Eigen::MatrixXd calcUnknownResponses(const ModelSpec& model, const ResponseLayout& layout,
                                     const Eigen::VectorXd& point);

/// The model with its excitation moved by so many standard deviations of each.
ModelSpec moveUnknown(ModelSpec model, const Eigen::VectorXd& moves);

/// The model with so much noise of one of its measured signals, a share of its root mean square, and all else
/// of the excitation known; none where it has no such signal, or one whose noise is stated. size: set to that
/// noise, in the signal's unit.
std::optional<ModelSpec> supposeNoise(const ModelSpec& model, std::size_t signal, double share, double& size);

/// What was lost of measured excitations and interpolated, a phrase each.
std::vector<std::string> describeBridged(const ModelSpec& model);

/// Leaves `count` samples of a table from `first` on, and what of them is not known.
void cutTable(std::size_t first, std::size_t count, TableSpec& table);

}  // namespace twinmap
