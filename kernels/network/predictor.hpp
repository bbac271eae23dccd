#pragma once

#include "kernels/network/network.hpp"

namespace twinmap::network {

/// A trained network made ready for one measurement after another: its first layer and the linear part of its
/// regression, which share the inputs, are one matrix; matrices of few rows lie row by row. Immutable.
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
    auto getHidden(Index units) const { return other.head(units); }

   private:
    friend class Predictor;
    VectorXd sums, other, standard, products;
    MatrixXd inverse;
  };

  const Network& getNetwork() const { return network_; }

  /// Mean, standard deviation and covariance of the targets for inputs (k), and those of the components where
  /// there are several, left in the workspace. Does not allocate. Cost: 2 flops a weight, an exponential a
  /// hidden unit, and p^3 / 3 a component.
  void predict(const Ref<const VectorXd>& inputs, Workspace& workspace) const;

 private:
  template <class Weights>
  static void propagate(const Weights& weights, const VectorXd& biases, Workspace& workspace);
  void mix(const Ref<const VectorXd>& head, Workspace& workspace) const;

  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Network network_;
  Layer first_;  // the first layer's sums, then the linear part of the regression
  // along rows, as these have few: an inference takes a tenth less
  RowMajor of_products_, head_;
};

}  // namespace twinmap::network
