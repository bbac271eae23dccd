#include "framework/inference/tolerances/onset_speeds.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/estimation/levels.hpp"
#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

bool usesParameters(const Expression& expression, const ModelSpec& model) {
  const std::vector<std::string> names = getUsedNames(expression);
  const auto uses = [&](const std::vector<ParameterSpec>& parameters) {
    return std::any_of(parameters.begin(), parameters.end(), [&](const ParameterSpec& parameter) {
      return std::find(names.begin(), names.end(), parameter.name.text) != names.end();
    });
  };
  return uses(model.parameters) || uses(model.nuisance);
}

/// Halves onset speeds that are not asked for; returns the places of those.
std::string halveOnsets(ModelSpec& model) {
  std::string places;
  const auto halve = [&](std::optional<Expression>& onset) {
    if (onset && !usesParameters(*onset, model)) {
      places += fmt::format("{}{}", places.empty() ? "" : ", ", toString(onset->where));
      onset->text = "0.5 * (" + onset->text + ")";
    }
  };
  for (Friction<Expression>& friction : model.system.elements.get<Friction>()) {
    halve(friction.onset_speed);
  }
  for (Contact<Expression>& contact : model.system.elements.get<Contact>()) {
    halve(contact.onset_speed);
  }
  return places;
}

}  // namespace

std::string describeOnsetSpeeds(const ExperimentSpec& experiment, IntegrationErrors& errors) {
  ModelSpec halved = experiment.model;
  const std::string places = halveOnsets(halved);
  if (places.empty()) {
    return "";
  }
  const std::optional<IntegrationError> change = errors.calcChange(experiment.model.simulation, halved);
  if (!change || change->shift <= kNoticeable) {
    return "";
  }
  const auto moved = static_cast<std::size_t>(change->parameter);
  return fmt::format(
      "{}: estimates depend on onset_speed: half of it moves {} by up to {:.2g} of its standard deviations\n"
      "  Take a speed far below those that matter, or 'model: lugre' or 'coulomb', which stick.",
      places, experiment.model.parameters[moved].name.text, change->shift);
}

}  // namespace twinmap
