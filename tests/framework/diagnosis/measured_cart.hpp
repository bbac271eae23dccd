#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/models/make_simulator.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {

inline const Eigen::VectorXd kTrueCart = Eigen::Vector3d(95.0, 1.2, 2500.0);

inline const char* const kSound = "F - k3*x^3";
inline const char* const kWithFriction = "F - k3*x^3 - 0.03*tanh(x_dot/0.01)";

/// The cart with another force law, and whatever else is overridden, measured.
inline Eigen::VectorXd measureCart(const std::string& force, int repeat = 0,
                                   std::vector<std::string> overrides = {}) {
  overrides.push_back("system.force_laws[0].force=" + force);
  const ExperimentSpec machine = loadExperiment(kCart, overrides);
  const ResponseLayout layout = makeLayout(machine);
  Eigen::MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(machine.model, layout.times)->simulate(kTrueCart, response, &status);
  const Eigen::MatrixXd noisy = addNoise(response, ResponseNoise(machine.noise, layout),
                                         {static_cast<std::uint64_t>(7 + repeat), RandomPurpose::kTestNoise});
  return makeExtractor(machine, layout).extract(noisy).col(0);
}

}  // namespace twinmap
