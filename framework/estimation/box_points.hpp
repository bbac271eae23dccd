#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

namespace twinmap {

/// Points of the box [-1, 1]^u: coordinates in half-widths of their bounds from the middle.
inline Eigen::VectorXd clampToBox(const Eigen::VectorXd& at) {
  return at.cwiseMax(-1.0).cwiseMin(1.0);
}

inline bool isInBox(const Eigen::Ref<const Eigen::VectorXd>& at) {
  return at.cwiseAbs().maxCoeff() <= 1.0;
}

/// How far one can go from `at` along `way` within limits, in lengths of `way`, at most `most`; 0 at a limit.
inline double calcReach(const Eigen::VectorXd& at, const Eigen::VectorXd& way, const Eigen::VectorXd& lower,
                        const Eigen::VectorXd& upper, double most) {
  double reach = most;
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    if (way[j] != 0.0) {
      reach = std::min(reach, ((way[j] > 0.0 ? upper[j] : lower[j]) - at[j]) / way[j]);
    }
  }
  return std::max(reach, 0.0);
}

/// The same within the box.
inline double calcReach(const Eigen::VectorXd& at, const Eigen::VectorXd& way,
                        double most = std::numeric_limits<double>::infinity()) {
  const Eigen::VectorXd upper = Eigen::VectorXd::Ones(at.size());
  return calcReach(at, way, -upper, upper, most);
}

/// map(column) of each column (vectors of one length), side by side.
template <class Map>
Eigen::MatrixXd mapColumns(const Eigen::MatrixXd& points, const Map& map) {
  Eigen::MatrixXd mapped(points.rows(), points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::VectorXd image = map(points.col(i));
    mapped.conservativeResize(image.size(), Eigen::NoChange);
    mapped.col(i) = image;
  }
  return mapped;
}

/// calc(points within the box), a number each; -infinity of the others, for which nothing is asked.
template <class Calc>
Eigen::VectorXd calcInBox(const Eigen::MatrixXd& points, const Calc& calc) {
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (isInBox(points.col(i))) {
      inside.push_back(i);
    }
  }
  Eigen::VectorXd found = Eigen::VectorXd::Constant(points.cols(), -std::numeric_limits<double>::infinity());
  if (!inside.empty()) {
    found(inside) = calc(Eigen::MatrixXd(points(Eigen::all, inside)));
  }
  return found;
}

}  // namespace twinmap
