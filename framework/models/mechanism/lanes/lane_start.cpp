#include "framework/models/mechanism/lanes/lane_start.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/equilibrium.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Parameters = Eigen::Ref<const VectorXd>;

LaneStart::LaneStart(const ModelSpec& spec, const LaneModel& model, const VectorXd& box_center,
                     const VectorXd& output_times)
    : spec_(spec),
      model_(model),
      box_center_(box_center),
      output_times_(output_times),
      start_(model.start),
      rest_(model) {
  if (model.loops) {
    assembly_.emplace(*model.loops, model.directions);
  }
}

void LaneStart::fill(const Parameters& parameters, lanes::Sample& sample) {
  // the values, then their derivatives along each direction
  const MatrixXd all = calcStart(parameters)
                           .reshaped(model_.start.outputs.size() / (1 + model_.directions.size()),
                                     1 + model_.countDirections());
  sample.parameters.assign(parameters.begin(), parameters.end());
  fillInitial(parameters, all.topRows(model_.counts.states), sample);
  const Index delays = static_cast<Index>(model_.sampling.delays.size());
  const Index events = all.rows() - model_.counts.states - delays;
  fillTimes({all.middleRows(model_.counts.states, events), all.bottomRows(delays), getOrigin(parameters)},
            sample);
}

VectorXd LaneStart::calcStart(const Parameters& parameters) {
  ProgramInputs inputs{parameters};
  inputs.phase_inputs = VectorXd::Zero(model_.counts.phase_inputs);
  const VectorXd values = start_.calc(inputs);
  if (model_.prescribed.empty()) {
    return values;
  }
  const auto events = values.segment(model_.counts.states, model_.excitation.events.size());
  const double origin = getOrigin(parameters);
  fillPhaseInputs(model_.excitation, std::vector<double>(events.begin(), events.end()), origin,
                  inputs.phase_inputs.data(), origin);
  return start_.calc(inputs);
}

/// Thousands of instants are the same for most samples.
void LaneStart::fillTimes(const SampleTimes& times, lanes::Sample& sample) {
  const bool same = !last_sample_.phases.empty() && times.events == last_times_.events &&
                    times.delays == last_times_.delays && times.origin == last_times_.origin;
  if (!same) {
    last_sample_.phases = {};  // where this fails nothing is kept
    fillPhases(model_, times, spec_.simulation.duration, output_times_, last_sample_);
    last_times_ = times;
  }
  sample.phases = last_sample_.phases;
  sample.end = last_sample_.end;
  sample.delays = last_sample_.delays;
}

void LaneStart::fillInitial(const Parameters& parameters, MatrixXd states, lanes::Sample& sample) {
  const MatrixXd given = states;
  if (box_center_.size() > 0) {
    states.setZero();
    states.col(0) = complete(box_center_);
    startPrescribed(given, states);
    assemble(parameters, states);
  } else if (spec_.initial.equilibrium) {
    rest_.setParameters(parameters);
    assemble(parameters, states);
    const MatrixXd start = takeEquilibrium(states);
    const VectorXd equilibrium = twinmap::solveEquilibrium(rest_, start.col(0));
    if (!model_.directions.empty()) {
      const MatrixXd slopes = rest_.calcSlopes(equilibrium, start.rightCols(model_.countDirections()));
      for (int k = 0; k < model_.countDirections(); ++k) {
        states.col(1 + k) = complete(slopes.col(k));
      }
    }
    states.col(0) = complete(equilibrium);
    if (assembly_) {
      assembly_->requireClosed(parameters, equilibrium.head(model_.coordinate_count));
    }
    if (!model_.prescribed.empty()) {
      startPrescribed(given, states);
      assemble(parameters, states);
    }
  } else {
    assemble(parameters, states);
  }
  sample.initial.assign(states.data(), states.data() + states.size());
}

void LaneStart::startPrescribed(const MatrixXd& given, MatrixXd& states) const {
  for (const int coordinate : model_.prescribed) {
    states.row(coordinate) = given.row(coordinate);
    states.row(model_.coordinate_count + coordinate) = given.row(model_.coordinate_count + coordinate);
  }
}

VectorXd LaneStart::complete(const VectorXd& equilibrium) const {
  VectorXd states = VectorXd::Zero(model_.counts.states);
  const Index known = model_.counts.states - model_.hidden_count;
  states.head(known) = insertSpeeds(equilibrium, VectorXd::Zero(model_.coordinate_count));
  return states;
}

void LaneStart::assemble(const Parameters& parameters, MatrixXd& states) {
  if (assembly_) {
    assembly_->assemble(parameters, states);
  }
}

MatrixXd LaneStart::takeEquilibrium(const MatrixXd& states) const {
  const Index n = model_.coordinate_count, m = model_.getFirstOrderCount();
  MatrixXd rows(n + m, states.cols());
  rows << states.topRows(n), states.middleRows(2 * n, m);
  return rows;
}

VectorXd LaneStart::solveEquilibrium(const Parameters& parameters) {
  rest_.setParameters(parameters);
  MatrixXd states = calcStart(parameters).head(model_.counts.states);
  if (box_center_.size() > 0) {
    states = complete(box_center_);
  }
  assemble(parameters, states);
  return twinmap::solveEquilibrium(rest_, takeEquilibrium(states));
}

VectorXd solveBoxCenter(ModelContext& context, const LaneModel& model) {
  const std::optional<EquilibriumSpec>& equilibrium = context.model.initial.equilibrium;
  if (!equilibrium || equilibrium->at != EquilibriumAt::kBoxCenter) {
    return {};
  }
  context.numbers.update(calcBoxCenter(collectSampled(context.model)));
  const VectorXd none;
  return LaneStart(context.model, model, none, none).solveEquilibrium(calcEquilibriumPoint(context));
}

}  // namespace twinmap
