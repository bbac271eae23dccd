#include "framework/estimation/trained/posterior_model.hpp"

namespace twinmap {

std::optional<PosteriorModel> findPosteriorModel(const OnlineMap& map,
                                                 const std::optional<TrustModel>& trust) {
  if (const Surrogate* surrogate = map.findSurrogate()) {
    return makePosteriorModel(*surrogate);
  }
  if (!trust) {
    return std::nullopt;
  }
  const Eigen::Index p = map.getResidualCorrelation().rows();
  return PosteriorModel{trust->forward, trust->center,           trust->half_width, p,
                        trust->unknown, Eigen::VectorXd::Ones(p)};
}

}  // namespace twinmap
