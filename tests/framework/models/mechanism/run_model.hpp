#pragma once

#include <gtest/gtest.h>

#include "framework/models/mechanism/simulator/multibody_simulator.hpp"
#include "tests/framework/models/mechanism/model_builder.hpp"

namespace twinmap::testing {

/// A model without parameters that starts from given values, integrated tightly.
inline ModelSpec makeModel(double duration) {
  ModelSpec model;
  model.system.gravity = ex3("0", "0", "0");
  model.simulation.duration = duration;
  model.simulation.relative_tolerance = 1e-10;
  model.simulation.absolute_tolerance = 1e-12;
  return model;
}

inline void start(ModelSpec& model, const std::string& coordinate, const std::string& at,
                  const std::string& speed = "0") {
  model.initial.coordinates.push_back(value(coordinate, at));
  model.initial.speeds.push_back(value(coordinate, speed));
}

inline StationOutputSpec along(const std::string& body, const Expression3& point,
                               const Expression3& direction) {
  return {station(body, point), direction};
}

/// One column an output, one row a time.
inline Eigen::MatrixXd runModel(const ModelSpec& model, const Eigen::VectorXd& times,
                                const Eigen::VectorXd& parameters = Eigen::VectorXd()) {
  MultibodySimulator simulator(model, times);
  Eigen::MatrixXd response(times.size() * model.outputs.size(), 1);
  SampleStatus status;
  simulator.simulate(parameters, response, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  return response.reshaped(times.size(), model.outputs.size());
}

/// Outputs at eight times within 1e-6 of the range of each.
template <std::size_t N>
void expectOutputs(const ModelSpec& model, const double (&times)[8], const double (&expected)[N][8]) {
  const Eigen::MatrixXd response = runModel(model, Eigen::Map<const Eigen::VectorXd>(times, 8));
  for (std::size_t o = 0; o < N; ++o) {
    const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(expected[o], 8);
    EXPECT_LT((response.col(o) - values).cwiseAbs().maxCoeff(),
              1e-6 * (values.maxCoeff() - values.minCoeff()))
        << o;
  }
}

/// Where derivatives by the first parameter are not asked for, those by the others stay and that one is 0.
inline void expectFirstHeld(ModelSpec model, const Eigen::VectorXd& times, int modes,
                            const Eigen::VectorXd& point, const Eigen::MatrixXd& derivatives) {
  ASSERT_FALSE(model.parameters.empty());
  model.parameters.front().has_derivatives = false;
  MultibodySimulator simulator(model, times, modes);
  Eigen::MatrixXd response(derivatives.rows(), 1), held;
  SampleStatus status;
  simulator.simulateWithDerivatives(point, response, held, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  EXPECT_EQ(held.col(0).cwiseAbs().maxCoeff(), 0.0);
  for (Eigen::Index k = 1; k < point.size(); ++k) {
    const Eigen::VectorXd difference = held.col(k) - derivatives.col(k);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-6 * (1e-3 + derivatives.col(k).cwiseAbs().maxCoeff()))
        << k;
  }
}

inline SampleStatus getStatus(const ModelSpec& model, const Eigen::VectorXd& parameters = Eigen::VectorXd()) {
  const Eigen::VectorXd times = Eigen::VectorXd::Constant(1, model.simulation.duration);
  MultibodySimulator simulator(model, times);
  Eigen::MatrixXd response(times.size() * model.outputs.size(), 1);
  SampleStatus status;
  simulator.simulate(parameters, response, &status);
  EXPECT_EQ(status.ok, status.reason.empty());
  return status;
}

/// The reason why a sample failed, or "".
inline std::string getReason(const ModelSpec& model, const Eigen::VectorXd& parameters = Eigen::VectorXd()) {
  return getStatus(model, parameters).reason;
}

/// What the constructor says against a model, or "".
inline std::string getError(const ModelSpec& model) {
  try {
    MultibodySimulator simulator(model, Eigen::VectorXd::Constant(1, model.simulation.duration));
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

}  // namespace twinmap::testing
