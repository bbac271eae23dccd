#include "framework/diagnosis/picture/fit_motion.hpp"

#include <algorithm>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

bool usesName(const Expression& expression, const std::string& name) {
  const std::vector<std::string> names = getUsedNames(expression);
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The force laws of a term: those behind the model's own that have its coefficient.
std::vector<TermForce> listForces(const Diagnosis& diagnosis, const ModelSpec& model, std::size_t term,
                                  const std::vector<ForcedCoordinate>& coordinates) {
  const ModelSpec& corrected = diagnosis.corrected.model;
  const auto& laws = corrected.system.elements.get<ForceLaw>();
  const std::string& coefficient =
      corrected.parameters[static_cast<std::size_t>(diagnosis.terms[term].first)].name.text;
  std::vector<TermForce> forces;
  for (std::size_t i = model.system.elements.get<ForceLaw>().size(); i < laws.size(); ++i) {
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
      if (coordinates[c].name == laws[i].coordinate.text && usesName(laws[i].force, coefficient)) {
        forces.push_back({term, c, laws[i].force});
      }
    }
  }
  return forces;
}

}  // namespace

FitMotion::FitMotion(const Diagnosis& diagnosis, const ExperimentSpec& experiment,
                     const RecordedFeatures& recordings)
    : diagnosis_(diagnosis), recordings_(recordings) {
  const ModelSpec& corrected = diagnosis.corrected.model;
  coordinates_ = listForcedCoordinates(corrected.system);
  const VectorXd times = VectorXd::LinSpaced(kMotionSamples, 0.0, corrected.simulation.duration);
  const RecordedMotion motion = simulate(0, times);
  std::vector<ForcedCoordinate> moving;
  for (std::size_t c = 0; c < coordinates_.size(); ++c) {
    if (motion.coordinates[c].speed.cwiseAbs().maxCoeff() > 0.0) {
      moving.push_back(coordinates_[c]);
    }
  }
  coordinates_ = std::move(moving);
  for (std::size_t term = 0; term < diagnosis.terms.size(); ++term) {
    const std::vector<TermForce> forces = listForces(diagnosis, experiment.model, term, coordinates_);
    forces_.insert(forces_.end(), forces.begin(), forces.end());
  }
}

RecordedMotion FitMotion::simulate(std::size_t recording, const VectorXd& times) const {
  const SingleRecording single =
      takeRecording(diagnosis_.corrected, recordings_, diagnosis_.after.posterior.best, recording);
  const ModelSpec& model = single.experiment.model;
  ModelSpec observed = model;
  observed.outputs.clear();
  for (const ForcedCoordinate& coordinate : coordinates_) {
    observeMotion(coordinate, observed.outputs);
  }
  for (const TermForce& force : forces_) {
    observeForce(std::to_string(force.term) + " on " + coordinates_[force.coordinate].name, force.force,
                 observed.outputs);
  }
  // controllers read them
  observed.outputs.insert(observed.outputs.end(), model.outputs.begin(), model.outputs.end());
  VectorXd point(single.point.size() + recordings_.known.size());
  point << single.point, recordings_.known;
  const MatrixXd outputs = simulateOutputs(observed, times, point);
  RecordedMotion motion;
  Index column = 0;
  for (std::size_t c = 0; c < coordinates_.size(); ++c, column += 2) {
    motion.coordinates.push_back({outputs.col(column), outputs.col(column + 1)});
  }
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    motion.forces.push_back(outputs.col(column++));
  }
  return motion;
}

}  // namespace twinmap
