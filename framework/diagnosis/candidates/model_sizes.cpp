#include "framework/diagnosis/candidates/model_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/observed_motion.hpp"
#include "framework/diagnosis/candidates/replace_name.hpp"
#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/gravity_name.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The force of a candidate with a coefficient of 1, at each value of its scale.
std::vector<std::string> listForces(const CandidateSpec& candidate) {
  if (!candidate.scale) {
    return {candidate.force.text};
  }
  std::vector<std::string> forces;
  for (const double value : candidate.scale->values) {
    forces.push_back(replaceName(candidate.force.text, candidate.scale->name.text, toText(value)));
  }
  return forces;
}

std::string nameGravity(const ForcedCoordinate& coordinate) {
  return coordinate.name + kGravitySuffix;
}

/// Whether it acts at all, and its force can be named.
bool hasGravity(const ModelSpec& model, const ModelSizes& sizes, const ForcedCoordinate& coordinate) {
  return sizes.gravity.norm() > 0.0 &&
         makeParameterName(model, nameGravity(coordinate)) == nameGravity(coordinate);
}

/// The model with each coordinate and its speed as outputs, then those of its own, its signals, and the
/// forces of candidates and of gravity.
ModelSpec observeSizes(const ExperimentSpec& experiment, const std::vector<ForcedCoordinate>& coordinates,
                       const ModelSizes& sizes) {
  const ModelSpec& model = experiment.model;
  ModelSpec observed = model;
  observed.outputs.clear();
  for (const ForcedCoordinate& coordinate : coordinates) {
    observeMotion(coordinate, observed.outputs);
  }
  observed.outputs.insert(observed.outputs.end(), model.outputs.begin(), model.outputs.end());
  for (OutputSpec& output : observed.outputs) {
    if (output.sensor) {
      output.sensor->delay.text.clear();  // a size has none, and an early one would look behind the end
    }
  }
  for (const SignalSpec& signal : model.excitation) {
    observeForce(signal.name.text, {signal.name.text, {}}, observed.outputs);
  }
  for (const CandidateSpec& candidate : experiment.candidates) {
    for (const std::string& force : listForces(candidate)) {
      observeForce(candidate.name.text, {force, candidate.force.where}, observed.outputs);
    }
  }
  for (const ForcedCoordinate& coordinate : coordinates) {
    if (hasGravity(model, sizes, coordinate)) {
      observeForce(nameGravity(coordinate), {nameGravity(coordinate), {}}, observed.outputs);
    }
  }
  return observed;
}

NamedValues<double> nameValues(const ModelSpec& model, const VectorXd& point) {
  NamedValues<double> names;
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    names.set(sampled[i].name.text, point[static_cast<Index>(i)]);
  }
  for (const ConstantSpec& constant : model.constants) {
    names.set(constant.name.text, names.calc(constant.value));
  }
  return names;
}

double calcLargest(const NamedValues<double>& names, const Expression3& expressions) {
  double largest = 0.0;
  for (const Expression& expression : expressions) {
    largest = std::max(largest, std::abs(names.calc(expression)));
  }
  return largest;
}

Extent calcExtent(const VectorXd& values) {
  const double largest = values.cwiseAbs().maxCoeff();
  return {largest, largest};
}

void setBodySizes(const ModelSpec& model, const NamedValues<double>& names, ModelSizes& sizes) {
  for (const BodySpec& body : model.system.bodies) {
    const double mass = names.calc(body.mass), moment = calcLargest(names, getMoments(body.inertia));
    const double gyradius = mass > 0.0 ? std::sqrt(moment / mass) : 0.0;
    sizes.masses.push_back(mass);
    sizes.moments.push_back(moment);
    sizes.lengths.push_back(std::max(calcLargest(names, body.center_of_mass), gyradius));
    sizes.mass += mass;
    sizes.moment += moment + mass * sizes.lengths.back() * sizes.lengths.back();
  }
  for (int i = 0; i < 3; ++i) {
    sizes.gravity[i] = names.calc(model.system.gravity[static_cast<std::size_t>(i)]);
  }
}

/// Of the coordinates that move; outputs: each one and its speed.
void setCoordinateSizes(const std::vector<ForcedCoordinate>& forced, const MatrixXd& outputs, double duration,
                        ModelSizes& sizes) {
  const double interval = duration / static_cast<double>(kMotionSamples - 1);
  for (std::size_t i = 0; i < forced.size(); ++i) {
    CoordinateSizes coordinate{forced[i].name, forced[i].is_angle};
    const auto column = static_cast<Index>(2 * i);
    const VectorXd speed = outputs.col(column + 1);
    const VectorXd acceleration =
        (speed.tail(kMotionSamples - 1) - speed.head(kMotionSamples - 1)) / interval;
    coordinate.reach = outputs.col(column).cwiseAbs().maxCoeff();
    coordinate.speed = speed.cwiseAbs().maxCoeff();
    coordinate.force = (coordinate.is_angle ? sizes.moment : sizes.mass) * acceleration.norm() /
                       std::sqrt(static_cast<double>(kMotionSamples - 1));
    if (coordinate.reach > 0.0 && coordinate.speed > 0.0 && coordinate.force > 0.0) {
      sizes.coordinates.push_back(coordinate);
    }
  }
}

/// Of rounding there is no force.
void setGravity(const std::string& name, const VectorXd& forces, ModelSizes& sizes) {
  const double least = 1e-9 * sizes.mass * sizes.gravity.norm(), largest = forces.cwiseAbs().maxCoeff();
  for (CoordinateSizes& coordinate : sizes.coordinates) {
    if (coordinate.name == name && largest > least) {
      coordinate.gravity = largest;
      coordinate.is_weighed = forces.maxCoeff() - forces.minCoeff() > least;
    }
  }
}

}  // namespace

ModelSizes calcModelSizes(const ExperimentSpec& experiment, const VectorXd& point) {
  const ModelSpec& model = experiment.model;
  ModelSizes sizes;
  setBodySizes(model, nameValues(model, point), sizes);
  const std::vector<ForcedCoordinate> forced = listForcedCoordinates(model.system);
  const VectorXd times = VectorXd::LinSpaced(kMotionSamples, 0.0, model.simulation.duration);
  const MatrixXd outputs = simulateOutputs(observeSizes(experiment, forced, sizes), times, point);
  setCoordinateSizes(forced, outputs, model.simulation.duration, sizes);
  auto column = static_cast<Index>(2 * forced.size());
  for (std::size_t o = 0; o < model.outputs.size(); ++o) {
    sizes.outputs.push_back(calcExtent(outputs.col(column++)));
  }
  for (std::size_t s = 0; s < model.excitation.size(); ++s) {
    sizes.signals.push_back(calcExtent(outputs.col(column++)));
  }
  for (const CandidateSpec& candidate : experiment.candidates) {
    sizes.own_forces.emplace_back();
    for (std::size_t k = 0; k < listForces(candidate).size(); ++k) {
      sizes.own_forces.back().push_back(outputs.col(column++).norm() /
                                        std::sqrt(static_cast<double>(kMotionSamples)));
    }
  }
  for (const ForcedCoordinate& coordinate : forced) {
    if (hasGravity(model, sizes, coordinate)) {
      setGravity(coordinate.name, outputs.col(column++), sizes);
    }
  }
  return sizes;
}

}  // namespace twinmap
