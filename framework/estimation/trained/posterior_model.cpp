#include "framework/estimation/trained/posterior_model.hpp"

#include "framework/estimation/surrogate/online_surrogate.hpp"

namespace twinmap {

std::optional<PosteriorModel> findPosteriorModel(const Estimator& map, const std::optional<TrustModel>& trust,
                                                 const ModelSpec& model) {
  if (const auto* surrogate = dynamic_cast<const OnlineSurrogate*>(&map)) {
    return makePosteriorModel(surrogate->getSurrogate(), findPrior(model));
  }
  if (!trust) {
    return std::nullopt;
  }
  const Eigen::Index p = map.getResidualCorrelation().rows();
  return PosteriorModel{trust->forward,           trust->center,   trust->half_width, p, trust->prior,
                        Eigen::VectorXd::Ones(p), findPrior(model)};
}

}  // namespace twinmap
