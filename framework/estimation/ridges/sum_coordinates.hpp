#pragma once

#include <vector>

#include "framework/estimation/log_coordinates.hpp"
#include "framework/estimation/ridges/identified_combinations.hpp"

namespace twinmap {

/// LogCoordinates v of u parameters, but with sums that are identified in the place of parameters that they
/// contain to the first power: with I + m L^2 in the place of I a ridge that is bent in all of them lies
/// along m and L. Volumes keep their ratios, and points within the bounds are within [-1, 1]^u.
class SumCoordinates {
 public:
  /// Takes the sums among the ridges' combinations whose parameter is in no other one.
  SumCoordinates(const std::vector<ParameterSpec>& unknown, const std::vector<Ridge>& ridges);

  bool isEmpty() const { return sums_.empty(); }
  /// The parameters that sums stand in the place of: those that LogCoordinates must take as they are.
  static std::vector<Eigen::Index> listReplaced(const std::vector<ParameterSpec>& unknown,
                                                const std::vector<Ridge>& ridges);

  Eigen::VectorXd toSums(const Eigen::VectorXd& v) const;
  /// Beyond the bounds too, of v.
  Eigen::VectorXd fromSums(const Eigen::VectorXd& z) const;
  /// dv / dz, u x u.
  Eigen::MatrixXd calcSlopes(const Eigen::VectorXd& v) const;

 private:
  struct Sum {
    Combination combination;
    Eigen::Index replaced;
    double coefficient;  ///< of the parameter that is replaced
    double largest;      ///< that its size can be within the bounds
  };

  static std::vector<Sum> listSums(const std::vector<ParameterSpec>& unknown,
                                   const std::vector<Ridge>& ridges);

  std::vector<Sum> sums_;
  LogCoordinates coordinates_;
};

}  // namespace twinmap
