#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/model/excitation_spec.hpp"
#include "framework/models/fmu/package/model_description.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap::testing {

/// An FMU of the tests and what is done with it, in this process.
struct FmuCase {
  std::string name;  ///< of fmus/build_fmus.py: "two_beam_2"
  fmi::Kind kind = fmi::Kind::kCoSimulation;
  std::map<std::string, double> parameters;
  std::map<std::string, std::string> units;  ///< of variables; "" if not here
  std::vector<SignalSpec> excitation;        ///< named as inputs
  std::vector<std::string> outputs;
  Eigen::VectorXd times;
  double duration = 1.0;
  std::optional<double> step;
};

/// One of the FMUs that a test is carried out with, and how it is simulated.
struct Way {
  const char* fmu;
  fmi::Kind kind;
};

struct FmuResult {
  SampleStatus status;
  Eigen::MatrixXd outputs;  ///< times x outputs
};

/// Path of the FMU.
std::string findFmu(const std::string& name);

/// Simulates `runs` times with one instance and returns the last.
FmuResult simulate(const FmuCase& fmu, int runs = 1);

/// `value` from `start` to `end`.
SignalSpec makePulse(const std::string& name, const std::string& unit, double value, double start,
                     double end);

}  // namespace twinmap::testing
