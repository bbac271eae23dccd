#include "framework/inference/joint/join_trials.hpp"

#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/estimation/refined/refinement_model.hpp"

namespace twinmap {

PosteriorProblem joinTrials(std::vector<MeasuredTrial> trials, const ModelSpec& model,
                            const std::function<std::string(std::size_t, const std::string&)>& name) {
  PosteriorProblem problem{model.parameters, model.priors, std::move(trials), 0};
  const auto shared = static_cast<Eigen::Index>(problem.unknown.size());
  for (std::size_t k = 0; k < problem.trials.size(); ++k) {
    MeasuredTrial& trial = problem.trials[k];
    const std::vector<ParameterSpec>& own = trial.model->getUnknown();
    for (std::size_t j = model.parameters.size(); j < own.size(); ++j) {
      trial.unknown[j] = static_cast<Eigen::Index>(problem.unknown.size());
      problem.unknown.push_back(own[j]);
      problem.unknown.back().name.text = name(k, own[j].name.text);
    }
  }
  const auto all = static_cast<Eigen::Index>(problem.unknown.size());
  problem.drawn = problem.trials.size() == 1 || all <= kFewUnknown ? all : shared;
  return problem;
}

}  // namespace twinmap
