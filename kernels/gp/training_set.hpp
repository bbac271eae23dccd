#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "kernels/gp/covariance/distances.hpp"
#include "kernels/gp/model.hpp"

namespace twinmap::gp {

/// What all targets, starts and threads share: the inputs' mean c, their distances, the Gram matrix of the
/// linear term and the basis of the mean function. Immutable. Memory: 8 n^2 min(G, 4) bytes and the like.
class TrainingSet {
 public:
  /// inputs: d x n. Throws std::invalid_argument if a value is not finite, n < 2, n is not above the number
  /// of mean coefficients, or the structure does not fit.
  TrainingSet(const Eigen::Ref<const Eigen::MatrixXd>& inputs, const ModelStructure& structure);

  Eigen::Index size() const { return inputs_->cols(); }
  const ModelStructure& getStructure() const { return structure_; }
  const Eigen::MatrixXd& getInputs() const { return *inputs_; }
  std::shared_ptr<const Eigen::MatrixXd> sharedInputs() const { return inputs_; }
  const SquaredDistances& distances() const { return *distances_; }
  /// (x_i - c)'(x_j - c) for i >= j, padded(n) x n; empty without the linear term.
  const Eigen::MatrixXd& gram() const { return gram_; }
  /// H', n x p: row i is h(x_i)'.
  const Eigen::MatrixXd& meanBasis() const { return mean_basis_; }

 private:
  ModelStructure structure_;
  std::shared_ptr<const Eigen::MatrixXd> inputs_;
  std::optional<SquaredDistances> distances_;
  Eigen::MatrixXd gram_;
  Eigen::MatrixXd mean_basis_;
};

/// c, the mean of the columns.
Eigen::VectorXd calcCenter(const Eigen::Ref<const Eigen::MatrixXd>& inputs);

/// h(x)' of each column of the centred inputs x - c, as rows: n x p.
Eigen::MatrixXd calcMeanBasis(MeanFunction mean, const Eigen::MatrixXd& centered);

}  // namespace twinmap::gp
