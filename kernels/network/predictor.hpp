#pragma once

#include "kernels/linalg/paired_matrix.hpp"
#include "kernels/network/network.hpp"

namespace twinmap::network {

/// A trained network made ready for one measurement after another: its matrices lie as a product reads them
/// in the least time, as most of it goes into reading them from beyond the first cache. Immutable. Weights of
/// layers are rounded (roundWeights).
class Predictor {
 public:
  explicit Predictor(Network network);

  /// The buffers of one thread, and the result.
  struct Workspace {
    explicit Workspace(const Predictor& predictor);
    VectorXd mean;        ///< p
    VectorXd stddev;      ///< p
    MatrixXd covariance;  ///< p x p
    // of each of c components; mean and covariance are then those of their mixture
    VectorXd weights;                   ///< c
    MatrixXd means;                     ///< p x c
    std::vector<MatrixXd> covariances;  ///< p x p each

    /// What the last hidden layer gave (h), of whose units there are so many.
    auto getHidden(Index units) const { return values.head(units); }

   private:
    friend class Predictor;
    VectorXd values, sums;  // into a layer, and out of it
    VectorXd terms, standard;
    MatrixXd inverse;
  };

  const Network& getNetwork() const { return network_; }

  /// Mean, standard deviation and covariance of the targets for inputs (k), and those of the components where
  /// there are several, left in the workspace. Does not allocate. Cost: 2 flops a weight, an exponential a
  /// hidden unit, and p^3 / 3 a component.
  void predict(const Ref<const VectorXd>& inputs, Workspace& workspace) const;

 private:
  void propagate(const Ref<const VectorXd>& inputs, Workspace& workspace) const;
  void mix(const Ref<const VectorXd>& head, Workspace& workspace) const;

  Network network_;
  std::vector<linalg::PairedMatrix> weights_;  // of the layers
  // along rows, as these are few
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> skip_;
};

}  // namespace twinmap::network
