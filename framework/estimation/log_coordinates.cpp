#include "framework/estimation/log_coordinates.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap {

using Eigen::Index;
using Eigen::Ref;
using Eigen::VectorXd;

LogCoordinates::LogCoordinates(const std::vector<ParameterSpec>& unknown, const std::vector<Index>& plain)
    : is_log_(static_cast<Index>(unknown.size())),
      center_(is_log_.size()),
      half_width_(is_log_.size()),
      log_center_(VectorXd::Zero(is_log_.size())),
      log_half_width_(VectorXd::Ones(is_log_.size())),
      sign_(VectorXd::Ones(is_log_.size())) {
  for (Index j = 0; j < is_log_.size(); ++j) {
    const Bounds& bounds = unknown[static_cast<std::size_t>(j)].bounds;
    center_[j] = 0.5 * (bounds.lower + bounds.upper);
    half_width_[j] = 0.5 * (bounds.upper - bounds.lower);
    is_log_[j] =
        (bounds.lower > 0.0 || bounds.upper < 0.0) && std::find(plain.begin(), plain.end(), j) == plain.end();
    if (is_log_[j]) {
      const double lower = std::log(std::abs(bounds.lower)), upper = std::log(std::abs(bounds.upper));
      sign_[j] = bounds.lower > 0.0 ? 1.0 : -1.0;
      log_center_[j] = 0.5 * (lower + upper);
      log_half_width_[j] = 0.5 * (upper - lower);
    }
  }
}

VectorXd LogCoordinates::toBox(const Ref<const VectorXd>& v) const {
  VectorXd u = v;
  for (Index j = 0; j < u.size(); ++j) {
    if (is_log_[j]) {
      u[j] = (sign_[j] * std::exp(log_center_[j] + log_half_width_[j] * v[j]) - center_[j]) / half_width_[j];
    }
  }
  return u;
}

VectorXd LogCoordinates::fromBox(const Ref<const VectorXd>& u) const {
  VectorXd v = u;
  for (Index j = 0; j < v.size(); ++j) {
    if (is_log_[j]) {
      const double size = sign_[j] * (center_[j] + half_width_[j] * u[j]);
      v[j] = (std::log(size) - log_center_[j]) / log_half_width_[j];
    }
  }
  return v;
}

VectorXd LogCoordinates::toParameters(const Ref<const VectorXd>& v) const {
  return center_ + half_width_.cwiseProduct(toBox(v));
}

VectorXd LogCoordinates::fromParameters(const Ref<const VectorXd>& x) const {
  return fromBox((x - center_).cwiseQuotient(half_width_).cwiseMax(-1.0).cwiseMin(1.0));
}

VectorXd LogCoordinates::calcSlopes(const Ref<const VectorXd>& v) const {
  VectorXd slopes = VectorXd::Ones(v.size());
  for (Index j = 0; j < v.size(); ++j) {
    if (is_log_[j]) {
      slopes[j] = sign_[j] * log_half_width_[j] * std::exp(log_center_[j] + log_half_width_[j] * v[j]) /
                  half_width_[j];
    }
  }
  return slopes;
}

double LogCoordinates::calcLogUniform(const Ref<const VectorXd>& v) const {
  return (is_log_.select(log_half_width_.cwiseProduct(v), 0.0)).sum();
}

}  // namespace twinmap
