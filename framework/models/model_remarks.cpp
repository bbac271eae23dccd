#include "framework/models/model_remarks.hpp"

#include <fmt/core.h>

#include <cmath>
#include <regex>
#include <set>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/jumps.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/models/mechanism/simulator/describe_model.hpp"

namespace twinmap {
namespace {

/// Of a system at the times that a simulator needs: one, which no excitation has to cover.
std::vector<std::string> listUnstable(const ModelSpec& model) {
  std::vector<std::string> remarks;
  try {
    const std::unique_ptr<Simulator> simulator = makeTrustedSimulator(model, Eigen::VectorXd::Zero(1), 0);
    for (const std::string& line : simulator->describeModel()) {
      if (line.rfind(kUnstableLine, 0) == 0) {
        const std::size_t what = line.find_first_not_of(' ', std::string(kUnstableLine).size());
        remarks.push_back("the model is unstable about its equilibrium: " + line.substr(what));
      }
    }
  } catch (const std::exception&) {
    // what cannot be simulated says so itself
  }
  return remarks;
}

}  // namespace

std::vector<std::string> listDegrees(const ModelSpec& model) {
  constexpr double kTurn = 6.283185307179586;  // rad; nobody writes more of them as one number
  static const std::regex kCall(R"(\b(sin|cos|tan)\(\s*(-?\d+(?:\.\d+)?)\s*\))");
  ExperimentSpec experiment;
  experiment.model = model;
  const std::string text = writeExperiment(experiment);
  std::set<std::string> remarks;
  for (std::sregex_iterator call(text.begin(), text.end(), kCall), end; call != end; ++call) {
    const std::string function = (*call)[1], angle = (*call)[2];
    if (std::abs(std::stod(angle)) > kTurn) {
      remarks.insert(
          fmt::format("{0}({1}) is of {1} rad: for degrees write {0}({1}*pi/180)", function, angle));
    }
  }
  return {remarks.begin(), remarks.end()};
}

std::vector<std::string> listModelRemarks(const ModelSpec& model) {
  if (model.source || !model.trials.empty()) {
    return {};
  }
  std::vector<std::string> remarks = listDegrees(model);
  for (const std::string& jump : listJumps(model.system)) {
    remarks.push_back("steps become small: " + jump);
  }
  const std::vector<std::string> unstable = listUnstable(model);
  remarks.insert(remarks.end(), unstable.begin(), unstable.end());
  return remarks;
}

}  // namespace twinmap
