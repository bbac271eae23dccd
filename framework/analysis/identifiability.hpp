#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/analysis/information_limit.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Which parameters, and which combinations of them, the data determine.
struct Identifiability {
  Eigen::MatrixXd correlation;   ///< p x p, of the inverse of the mean Fisher information with the prior
  Eigen::VectorXd eigenvalues;   ///< p, of the mean Fisher information, ascending; per width^2
  Eigen::MatrixXd eigenvectors;  ///< p x p, columns, in widths; the largest entry of each is positive
  Eigen::VectorXd remaining;  ///< p: root mean square limit over the prior's own standard deviation, (0, 1]
  std::vector<std::string> warnings;  ///< one for each parameter that stays undetermined, with the reason

  /// Whether even the limit leaves more than half of the standard deviation that the prior alone gives.
  bool isUndetermined(Eigen::Index parameter) const { return remaining[parameter] > 0.5; }
};

/// The reason why a parameter is undetermined is that no feature follows it, or that others do the same to
/// the features: then those are named whose errors go with its own (correlation above 0.5 in the mean of the
/// limit's covariances; the mean information itself may look well conditioned although every sample's is
/// singular, each in another direction).
Identifiability calcIdentifiability(const InformationLimit& limit,
                                    const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
