#include "framework/estimation/trained/posterior_model.hpp"

namespace twinmap {

std::optional<PosteriorModel> findPosteriorModel(const OnlineMap& map, const std::optional<TrustModel>& trust,
                                                 const ModelSpec& model) {
  if (const Surrogate* surrogate = map.findSurrogate()) {
    return makePosteriorModel(*surrogate, findPrior(model));
  }
  if (!trust) {
    return std::nullopt;
  }
  const Eigen::Index p = map.getResidualCorrelation().rows();
  return PosteriorModel{trust->forward,           trust->center,   trust->half_width, p, trust->prior,
                        Eigen::VectorXd::Ones(p), findPrior(model)};
}

}  // namespace twinmap
