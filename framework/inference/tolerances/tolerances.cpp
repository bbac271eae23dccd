#include "framework/inference/tolerances/tolerances.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "framework/base/log/log.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/tolerances/onset_speeds.hpp"
#include "framework/models/model_remarks.hpp"

namespace twinmap {
namespace {

constexpr double kMinRelative = 1e-13, kMinAbsolute = 1e-18;  // that the experiment file accepts

/// value / 10^decades to its digits, so that 3e-7 becomes 3e-8, not 3.0000000000000004e-8.
double divide(double value, int decades) {
  double divided = 0.0;
  parseLiteral(fmt::format("{:.12g}", value / std::pow(10.0, decades)), divided);
  return divided;
}

/// The tolerances of a simulation, those divided by powers of ten that may be.
SimulationSpec tighten(SimulationSpec simulation, bool relative, bool absolute, int decades) {
  if (relative) {
    simulation.relative_tolerance = divide(simulation.relative_tolerance, decades);
  }
  if (absolute) {
    simulation.absolute_tolerance = divide(simulation.absolute_tolerance, decades);
  }
  return simulation;
}

bool isAllowed(const SimulationSpec& simulation) {
  return simulation.relative_tolerance >= kMinRelative && simulation.absolute_tolerance >= kMinAbsolute;
}

/// A simulation whose errors are negligible, or the best that was found, with its error.
struct Tightened {
  SimulationSpec simulation;
  IntegrationError error;
};

/// Goes from one tolerance to the next by the powers of ten that the error is too large by. Errors fall about
/// as the tolerance does. It never goes beyond what is allowed or can still be simulated.
Tightened search(IntegrationErrors& errors, const Tightened& from, bool relative, bool absolute) {
  Tightened best = from;
  if (!relative && !absolute) {
    return best;
  }
  for (int decades = 0; !best.error.isNegligible();) {
    decades += std::max(1, static_cast<int>(best.error.calcDecades()));
    SimulationSpec next = tighten(from.simulation, relative, absolute, decades);
    if (!isAllowed(next)) {
      break;
    }
    const std::optional<IntegrationError> error = errors.calc(next);
    if (!error || error->calcDecades() > best.error.calcDecades()) {
      break;
    }
    best = {next, *error};
  }
  return best;
}

std::string describe(const SimulationSpec& simulation) {
  return fmt::format("{} (absolute {})", toText(simulation.relative_tolerance),
                     toText(simulation.absolute_tolerance));
}

/// "moves k3 by up to 12 of its standard deviations"
std::string describe(const IntegrationError& error, const std::vector<ParameterSpec>& parameters) {
  if (error.shift <= kImmaterial) {
    return fmt::format("raises chi-square by up to {:.2g} of its standard deviations", error.rise);
  }
  return fmt::format("moves {} by up to {:.2g} of its standard deviations",
                     parameters[static_cast<std::size_t>(error.parameter)].name.text, error.shift);
}

/// The values that the file gives, with their places: "exp.yaml:7:3: simulation.relative_tolerance: 1e-05".
std::string nameGiven(const SimulationSpec& simulation) {
  std::string named;
  for (const Tolerance* given : {&simulation.relative_tolerance, &simulation.absolute_tolerance}) {
    if (!given->automatic) {
      named += fmt::format("{}{}: {}", named.empty() ? "" : ", ", toString(given->where), toText(*given));
    }
  }
  return named;
}

void warnOfCoarse(const ModelSpec& model, const IntegrationError& error, const Tightened& enough) {
  logWarning(
      fmt::format("{}: too coarse for the noise: the error of the integration {}; "
                  "relative_tolerance: {} and absolute_tolerance: {} {}, or leave both out",
                  nameGiven(model.simulation), describe(error, model.parameters),
                  toText(enough.simulation.relative_tolerance), toText(enough.simulation.absolute_tolerance),
                  enough.error.isNegligible() ? "would do" : "are the best that can be had"));
}

/// One line: from what, to what, why; what is left where that is not negligible.
void logTightened(const ModelSpec& model, const IntegrationError& error, const Tightened& taken) {
  const std::vector<std::string> remarks = listModelRemarks(model);
  if (!remarks.empty()) {  // as that the model is unstable
    logWarning(fmt::format("{}; integration tolerances tightened to {}", remarks.front(),
                           describe(taken.simulation)));
    return;
  }
  const std::string text =
      fmt::format("integration tolerances tightened to {}; with {} the error of the integration {}",
                  describe(taken.simulation), describe(model.simulation), describe(error, model.parameters));
  if (taken.error.isNegligible()) {
    logInfo(text);
  } else {
    logWarning(text + "; what is left " + describe(taken.error, model.parameters));
  }
}

/// What is integrated with twinmap's own error control, and seen through noise.
bool canFollow(const ExperimentSpec& experiment) {
  const ModelSpec& model = experiment.model;
  return !collectOutputs(experiment.features).empty() && experiment.noise.scale > 0.0 &&
         !(model.source && model.source->program);
}

void followOne(ExperimentSpec& experiment) {
  SimulationSpec& simulation = experiment.model.simulation;
  if (!canFollow(experiment)) {
    simulation.relative_tolerance.automatic = simulation.absolute_tolerance.automatic = false;
    return;
  }
  const bool relative = simulation.relative_tolerance.automatic,
             absolute = simulation.absolute_tolerance.automatic;
  SimulationSpec fixed = simulation;
  fixed.relative_tolerance.automatic = fixed.absolute_tolerance.automatic = false;
  IntegrationErrors errors(experiment);
  const std::optional<IntegrationError> error = errors.calc(simulation);
  if (error && !error->isNegligible()) {
    const Tightened found = search(errors, {fixed, *error}, relative, absolute);
    if (found.error.isNegligible() || (relative && absolute)) {
      logTightened(experiment.model, *error, found);
      fixed = found.simulation;
    } else {
      warnOfCoarse(experiment.model, *error, search(errors, {fixed, *error}, true, true));
    }
  }
  simulation = fixed;
  if (const std::string warning = describeOnsetSpeeds(experiment, errors); !warning.empty()) {
    logWarning(warning);
  }
}

/// Of the experiment, or of each trial that it combines. Those of a model that cannot be simulated stay: the
/// case itself fails, and says why, while others go on.
std::vector<SimulationSpec> followOrKeep(const ExperimentSpec& experiment) {
  std::vector<SimulationSpec> followed;
  ExperimentSpec copy = experiment;
  changeTrials(copy, [&](ExperimentSpec& one) {
    try {
      followOne(one);
    } catch (const std::exception&) {
    }
    followed.push_back(one.model.simulation);
  });
  return followed;
}

void takeTolerances(const std::vector<SimulationSpec>& followed, ExperimentSpec& experiment) {
  auto next = followed.begin();
  changeTrials(experiment, [&](ExperimentSpec& one) {
    one.model.simulation.relative_tolerance = next->relative_tolerance;
    one.model.simulation.absolute_tolerance = next->absolute_tolerance;
    ++next;
  });
}

std::vector<double> listTolerances(const std::vector<SimulationSpec>& simulations) {
  std::vector<double> tolerances;
  for (const SimulationSpec& simulation : simulations) {
    tolerances.push_back(simulation.relative_tolerance);
    tolerances.push_back(simulation.absolute_tolerance);
  }
  return tolerances;
}

}  // namespace

ExperimentSpec followNoise(ExperimentSpec experiment) {
  changeTrials(experiment, followOne);
  return experiment;
}

void followNoise(std::vector<SweepCase>& cases) {
  std::map<std::string, std::vector<SimulationSpec>> known;
  std::map<std::pair<int, std::vector<double>>, int> models;
  for (SweepCase& one : cases) {
    ExperimentSpec key;
    key.model = one.experiment.model;
    key.features = one.experiment.features;
    key.noise = one.experiment.noise;
    key.noise.replicates.reset();
    key.trials = one.experiment.trials;
    const auto [entry, is_new] = known.emplace(writeExperiment(key), std::vector<SimulationSpec>{});
    if (is_new) {
      entry->second = followOrKeep(one.experiment);
    }
    takeTolerances(entry->second, one.experiment);
    const auto index = static_cast<int>(&one - cases.data());
    one.model = models.emplace(std::pair(one.model, listTolerances(entry->second)), index).first->second;
  }
}

}  // namespace twinmap
