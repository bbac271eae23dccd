#include "framework/models/mechanism/lanes/lane_model.hpp"

#include "kernels/lanes/program/differentiate.hpp"

namespace twinmap {
namespace {

using program::Symbol;
using Symbols = RecordedModel::Symbols;

void append(const Symbols& more, Symbols& symbols) {
  symbols.insert(symbols.end(), more.begin(), more.end());
}

/// Appends the derivatives of `values` with respect to each variable.
void appendJacobian(const Symbols& values, const Symbols& variables, Symbols& symbols) {
  for (const Symbols& column : program::calcJacobian(values, variables)) {
    append(column, symbols);
  }
}

Symbols getParameters(const RecordedModel& recorded, const std::vector<int>& directions) {
  Symbols parameters;
  for (const int direction : directions) {
    parameters.push_back(recorded.recorder->parameter(direction));
  }
  return parameters;
}

Symbols collectStart(const RecordedModel& recorded, const Symbols& parameters) {
  Symbols values = recorded.initial;
  append(recorded.excitation.events, values);
  append(recorded.sampling.delays, values);
  Symbols outputs = values;
  appendJacobian(values, parameters, outputs);
  return outputs;
}

int countStates(const RecordedModel& recorded) {
  return static_cast<int>(recorded.derivatives.size());
}

Symbols collectRest(const RecordedModel& recorded, const Symbols& parameters) {
  Symbols residuals = recorded.rest_rates, variables;
  append(recorded.rest_closures, residuals);
  Symbols outputs = residuals;
  append(recorded.rest_pivots, outputs);
  for (int i = 0; i < recorded.coordinate_count; ++i) {
    variables.push_back(recorded.recorder->state(i));
  }
  for (int i = 0; i < recorded.state_count; ++i) {
    variables.push_back(recorded.recorder->state(2 * recorded.coordinate_count + i));
  }
  append(parameters, variables);
  appendJacobian(residuals, variables, outputs);
  return outputs;
}

RestPrograms compileRest(const RecordedModel& recorded, const std::vector<int>& directions,
                         const program::InputCounts& counts) {
  const Symbols parameters = getParameters(recorded, directions);
  program::Recorder& recorder = *recorded.recorder;
  RestPrograms programs;
  programs.residuals = program::compile(recorder, collectRest(recorded, parameters), counts);
  programs.pivot_count = static_cast<int>(recorded.rest_pivots.size());
  programs.linearization = program::compile(recorder, recorded.linearization, counts);
  return programs;
}

/// Outputs are then functions of the time and the parameters alone: the signals have taken the place of all
/// states, and the pivots are those of a unit matrix.
bool isMemoryless(const RecordedModel& recorded) {
  const auto prescribed = static_cast<int>(recorded.prescribed.size());
  return prescribed == recorded.coordinate_count && countStates(recorded) == 2 * prescribed &&
         !recorded.loops && recorded.sampling.jumps.empty() && recorded.events.guards.empty();
}

lanes::Equations makeEquations(const RecordedModel& recorded, const LaneModel& model) {
  const RecordedSampling& sampling = recorded.sampling;
  lanes::Equations equations{model.counts, recorded.derivatives, recorded.pivots, sampling.outputs};
  equations.delays.assign(sampling.delays.begin(), sampling.delays.begin() + sampling.output_delay_count);
  equations.output_delays = sampling.output_delays;
  if (model.is_memoryless) {
    equations.counts.states = 0;
    equations.derivatives.clear();
    equations.pivots.clear();
    return equations;
  }
  equations.jumps = sampling.jumps;
  equations.passed = sampling.passed;
  equations.guards = recorded.events.guards;
  equations.transitions = recorded.events.transitions;
  equations.event_input = recorded.events.input;
  equations.projection = recorded.projected;
  equations.dips = recorded.events.dips;
  return equations;
}

}  // namespace

LaneModel compileModel(const RecordedModel& recorded, const std::vector<int>& directions) {
  program::Recorder& recorder = *recorded.recorder;
  const Symbols parameters = getParameters(recorded, directions);
  LaneModel model;
  model.coordinate_count = recorded.coordinate_count;
  model.origin_parameter = recorded.origin_parameter;
  model.hidden_count = recorded.mode_count + static_cast<int>(recorded.sampling.hidden_rates.size());
  model.counts = {countStates(recorded), recorded.parameter_count, recorded.sampling.input_count};
  model.excitation = recorded.excitation;
  model.sampling = recorded.sampling;
  model.directions = directions;
  model.loops = recorded.loops;
  model.prescribed = recorded.prescribed;
  model.is_memoryless = isMemoryless(recorded);
  model.problem = lanes::makeProblem(recorder, makeEquations(recorded, model), directions);
  model.start = program::compile(recorder, collectStart(recorded, parameters), model.counts);
  if (recorded.record_with_rest) {
    model.at_rest = std::make_shared<DeferredRest>(
        [record = recorded.record_with_rest, directions, counts = model.counts] {
          return compileRest(record(), directions, counts);
        });
  } else {
    model.at_rest = std::make_shared<DeferredRest>(
        [programs = compileRest(recorded, directions, model.counts)] { return programs; });
  }
  return model;
}

StiffPrograms compileStiff(const RecordedModel& recorded) {
  const program::InputCounts counts{countStates(recorded), recorded.parameter_count,
                                    recorded.sampling.input_count};
  const Symbols& derivatives = recorded.relaxed.empty() ? recorded.derivatives : recorded.relaxed;
  Symbols states, rows = derivatives, jacobian;
  append(recorded.pivots, rows);
  for (int i = 0; i < counts.states; ++i) {
    states.push_back(recorded.recorder->state(i));
  }
  appendJacobian(derivatives, states, jacobian);
  return {program::compile(*recorded.recorder, rows, counts),
          program::compile(*recorded.recorder, jacobian, counts)};
}

}  // namespace twinmap
