#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

/// At a centre of 1, where units show.
ParameterSpec makeSomeParameter(const Name& name, const std::string& unit) {
  ParameterSpec parameter;
  parameter.name = name;
  parameter.bounds = {0.5, 1.5, name.where};
  parameter.unit = unit;
  return parameter;
}

}  // namespace

void checkCandidates(const ExperimentSpec& experiment) {
  for (const CandidateSpec& candidate : experiment.candidates) {
    if (!isGiven(experiment.model.system)) {
      throw ExperimentError(candidate.name.where, candidate.name.text,
                            "is a force on a coordinate, which only a 'system' of bodies has");
    }
    ModelSpec model = experiment.model;
    model.parameters.push_back(makeSomeParameter(candidate.name, candidate.unit));
    if (candidate.scale) {
      model.parameters.push_back(makeSomeParameter(candidate.scale->name, candidate.scale->unit));
    }
    ForceLaw<Expression> law;
    law.coordinate = candidate.coordinate;
    law.force = {candidate.name.text + "*(" + candidate.force.text + ")", candidate.force.where};
    model.system.elements.get<ForceLaw>().push_back(law);
    checkModel(model);
  }
}

}  // namespace twinmap
