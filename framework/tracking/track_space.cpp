#include "framework/tracking/track_space.hpp"

#include <cmath>

#include "framework/estimation/box_prior.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TrackSpace::TrackSpace(const std::vector<ParameterSpec>& parameters)
    : center_(static_cast<Index>(parameters.size())), half_width_(center_.size()) {
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const Bounds& bounds = parameters[j].bounds;
    is_log_.push_back(parameters[j].prior && parameters[j].prior->isOfLogarithm());
    const double lower = is_log_[j] ? std::log(bounds.lower) : bounds.lower;
    const double upper = is_log_[j] ? std::log(bounds.upper) : bounds.upper;
    center_[static_cast<Index>(j)] = 0.5 * (lower + upper);
    half_width_[static_cast<Index>(j)] = 0.5 * (upper - lower);
  }
}

double TrackSpace::toCoordinate(Index j, double value) const {
  return ((is_log_[static_cast<std::size_t>(j)] ? std::log(value) : value) - center_[j]) / half_width_[j];
}

double TrackSpace::toValue(Index j, double coordinate) const {
  const double value = center_[j] + half_width_[j] * coordinate;
  return is_log_[static_cast<std::size_t>(j)] ? std::exp(value) : value;
}

double TrackSpace::calcSlope(Index j, double value) const {
  return 1.0 / (half_width_[j] * (is_log_[static_cast<std::size_t>(j)] ? value : 1.0));
}

TrackPrior makeTrackPrior(const ModelSpec& model, const TrackSpace& space) {
  const BoxPrior box = makeBoxPrior(model);
  const Index p = space.count(), u = box.count();
  const MatrixXd covariance =
      linalg::solveSemidefinite(box.calcInformation(), MatrixXd::Identity(u, u)).topLeftCorner(p, p);
  TrackPrior made{{VectorXd(p), MatrixXd(p, p)}, {}};
  tracking::Belief& prior = made.belief;
  VectorXd scale(p);
  for (Index j = 0; j < p; ++j) {
    const Bounds& bounds = model.parameters[static_cast<std::size_t>(j)].bounds;
    const double half_width = 0.5 * (bounds.upper - bounds.lower);
    const double value = 0.5 * (bounds.upper + bounds.lower) + half_width * box.mean[j];
    prior.mean[j] = space.toCoordinate(j, value);
    scale[j] = half_width * space.calcSlope(j, value);
  }
  prior.covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  for (Index j = 0; j < p; ++j) {
    const std::optional<PriorSpec>& stated = model.parameters[static_cast<std::size_t>(j)].prior;
    const bool is_log_uniform = stated && std::holds_alternative<LogUniformPrior>(stated->kind);
    if (is_log_uniform || box.within.row(j).isZero(0.0)) {
      made.uniform.push_back(j);
    }
  }
  return made;
}

}  // namespace twinmap
