#pragma once

#include <functional>
#include <string>
#include <vector>

#include "framework/estimation/posterior/posterior_problem.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What all of `trials` (one or more) say of one machine: of the parameters of `model`, then of what each
/// leaves unknown besides, which is called name(k, its name) of trial k. Where these are more than eight in
/// all, those of single trials are integrated out.
PosteriorProblem joinTrials(std::vector<MeasuredTrial> trials, const ModelSpec& model,
                            const std::function<std::string(std::size_t, const std::string&)>& name);

}  // namespace twinmap
