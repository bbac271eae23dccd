#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/box_points.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// The parameters that a refinement searches: `count` of the sampled box from `first` on; the others are
/// held.
struct SearchedParameters {
  Eigen::Index first = 0, count = 0;
};

/// The searched parameters in half-widths of their bounds from the middle, so that [-1, 1] is the box, and
/// where the search may go: noise puts the best answer a little outside. Immutable.
class SearchBox {
 public:
  /// `held`: a point of the sampled box, of which the parameters that are not searched are kept.
  SearchBox(const std::vector<ParameterSpec>& unknown, const SearchedParameters& searched,
            Eigen::VectorXd held);

  /// The limits of the search: the box, enlarged by 5 % of its width on each side, but never through zero: a
  /// stiffness, a mass or a friction that is bounded by zero has no other sign.
  const Eigen::VectorXd& getLower() const { return lower_; }
  const Eigen::VectorXd& getUpper() const { return upper_; }
  const Eigen::VectorXd& getHalfWidths() const { return half_widths_; }
  const SearchedParameters& getSearched() const { return searched_; }

  /// The searched coordinates (s) of a point of the sampled box, moved within the limits.
  Eigen::VectorXd normalize(const Eigen::VectorXd& point) const;
  Eigen::VectorXd clamp(const Eigen::VectorXd& at) const { return at.cwiseMax(lower_).cwiseMin(upper_); }
  /// How far one can go from `at` along `way` within the limits, in lengths of `way`, at most `most`.
  double calcReach(const Eigen::VectorXd& at, const Eigen::VectorXd& way, double most) const {
    return twinmap::calcReach(at, way, lower_, upper_, most);
  }
  /// The point of the sampled box; those of all columns of `points` (s x n).
  Eigen::VectorXd makePoint(const Eigen::VectorXd& at) const;
  Eigen::MatrixXd makePoints(const Eigen::MatrixXd& points) const {
    return mapColumns(points, [this](const Eigen::VectorXd& at) { return makePoint(at); });
  }

 private:
  SearchedParameters searched_;
  Eigen::VectorXd held_, center_, half_widths_, lower_, upper_;
};

}  // namespace twinmap
