#include "framework/estimation/refined/search_box.hpp"

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kBeyond = 0.1;  // half-widths: 5 % of the width

/// The limit beside a bound on the side of `direction` (-1, 1), in half-widths.
double calcLimit(const Bounds& bounds, double direction) {
  const double bound = direction < 0.0 ? bounds.lower : bounds.upper;
  const double beyond = bound + direction * kBeyond * 0.5 * (bounds.upper - bounds.lower);
  const bool keeps_sign = bound > 0.0 ? beyond > 0.0 : bound < 0.0 && beyond < 0.0;
  return keeps_sign || bounds.lower * bounds.upper < 0.0 ? direction * (1.0 + kBeyond) : direction;
}

}  // namespace

SearchBox::SearchBox(const std::vector<ParameterSpec>& unknown, const SearchedParameters& searched,
                     VectorXd held)
    : searched_(searched),
      held_(std::move(held)),
      center_(calcBoxCenter(unknown).segment(searched.first, searched.count)),
      half_widths_(0.5 * calcWidths(unknown).segment(searched.first, searched.count)),
      lower_(searched.count),
      upper_(searched.count) {
  for (Index j = 0; j < searched.count; ++j) {
    const Bounds& bounds = unknown[static_cast<std::size_t>(searched.first + j)].bounds;
    lower_[j] = calcLimit(bounds, -1.0);
    upper_[j] = calcLimit(bounds, 1.0);
  }
}

VectorXd SearchBox::normalize(const VectorXd& point) const {
  return clamp((point.segment(searched_.first, searched_.count) - center_).cwiseQuotient(half_widths_));
}

VectorXd SearchBox::makePoint(const VectorXd& at) const {
  VectorXd point = held_;
  point.segment(searched_.first, searched_.count) = center_ + at.cwiseProduct(half_widths_);
  return point;
}

}  // namespace twinmap
