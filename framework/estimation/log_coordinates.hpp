#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap {

/// Coordinates in which products and quotients of parameters are straight: of each parameter, v in [-1, 1] is
/// its logarithm scaled to the bounds where both bounds have one sign, else the parameter itself. What
/// depends on k / m or m l alone has a bent ridge as its likelihood in the parameters, and a plane one here.
/// u in [-1, 1] is the parameter in half-widths of its bounds, as everywhere. Immutable.
class LogCoordinates {
 public:
  /// Of u parameters, those that are unknown. plain: places of parameters that are taken as they are whatever
  /// their bounds, as a sum wants it (findPlainParameters).
  explicit LogCoordinates(const std::vector<ParameterSpec>& unknown,
                          const std::vector<Eigen::Index>& plain = {});

  Eigen::Index getCount() const { return is_log_.size(); }
  bool isLog(Eigen::Index j) const { return is_log_[j]; }

  Eigen::VectorXd toBox(const Eigen::Ref<const Eigen::VectorXd>& v) const;    ///< v -> u
  Eigen::VectorXd fromBox(const Eigen::Ref<const Eigen::VectorXd>& u) const;  ///< u -> v; u within the bounds
  Eigen::VectorXd toParameters(const Eigen::Ref<const Eigen::VectorXd>& v) const;  ///< in their units
  /// Moved within the bounds.
  Eigen::VectorXd fromParameters(const Eigen::Ref<const Eigen::VectorXd>& x) const;
  const Eigen::VectorXd& getHalfWidths() const { return half_width_; }  ///< of the bounds
  /// du / dv of each parameter.
  Eigen::VectorXd calcSlopes(const Eigen::Ref<const Eigen::VectorXd>& v) const;
  /// log of the density in v of what is uniform in u, but for a summand: sum log du/dv.
  double calcLogUniform(const Eigen::Ref<const Eigen::VectorXd>& v) const;

 private:
  Eigen::Array<bool, Eigen::Dynamic, 1> is_log_;
  Eigen::VectorXd center_, half_width_;          // of the parameters
  Eigen::VectorXd log_center_, log_half_width_;  // of the logarithms of their sizes
  Eigen::VectorXd sign_;
};

}  // namespace twinmap
