#include "framework/estimation/trained/posterior_model.hpp"

#include <fmt/core.h>

#include "framework/base/text/nearest_name.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

/// Names of quantities, the last of which, one more than parameters, is all of them together.
std::string name(const std::vector<Index>& quantities, const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> names;
  for (const Index q : quantities) {
    const auto k = static_cast<std::size_t>(q);
    names.push_back(k < parameters.size() ? parameters[k].name.text : "all parameters together");
  }
  return listNames(names);
}

std::string describeRanks(const RankRecord& posteriors, const std::vector<ParameterSpec>& parameters) {
  const std::vector<Index> uneven = posteriors.listUneven();
  return uneven.empty()
             ? ""
             : fmt::format("true values of the run's {} test samples rank unevenly among its draws: {}",
                           posteriors.ranked, name(uneven, parameters));
}

}  // namespace

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

std::string findPosteriorDoubt(const Estimator& map, const std::optional<TrustModel>& trust,
                               const std::vector<ParameterSpec>& parameters) {
  if (trust && trust->posteriors.ranked > 0) {
    return describeRanks(trust->posteriors, parameters);
  }
  const auto* surrogate = dynamic_cast<const OnlineSurrogate*>(&map);
  if (surrogate == nullptr) {
    return "nothing has compared it with true values (evaluation.calibration=sbc does)";
  }
  const std::vector<Index> enlarged = surrogate->getSurrogate().validation.listEnlarged();
  return enlarged.empty() ? ""
                          : "cross-validation found it too narrow, which a factor mends but in part: " +
                                name(enlarged, parameters);
}

}  // namespace twinmap
