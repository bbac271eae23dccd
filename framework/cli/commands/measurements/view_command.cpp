#include <filesystem>
#include <iostream>
#include <map>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/infer_estimate.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/view/page.hpp"
#include "framework/view/picture.hpp"

namespace twinmap::cli {
namespace {

namespace fs = std::filesystem;

ExperimentSpec loadExperiment(const ExperimentArguments& arguments) {
  const std::string ending = fs::path(arguments.file).extension().string();
  if (ending == ".yaml" || ending == ".yml") {
    return readExperimentWithSignals(loadExperimentTree(arguments.file, arguments.overrides));
  }
  if (!arguments.overrides.empty()) {
    throw ExperimentError("view: KEY=VALUE is of experiment files; a run has its own");
  }
  return InferenceSource(arguments.file).getExperiment();
}

/// The centre of the bounds, but for what was estimated.
Eigen::VectorXd makePoint(const ModelSpec& model, const std::map<std::string, double>& estimated) {
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  Eigen::VectorXd point = calcBoxCenter(sampled);
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    const auto found = estimated.find(sampled[i].name.text);
    if (found != estimated.end()) {
      point[static_cast<Eigen::Index>(i)] = found->second;
    }
  }
  return point;
}

}  // namespace

void view(const ViewArguments& arguments) {
  const ExperimentSpec experiment = loadExperiment(arguments.experiment);
  requireOneTrial(experiment, "a picture is of one");
  twinmap::view::Scene scene =
      twinmap::view::makeScene(experiment, makePoint(experiment.model, {}), "nominal");
  if (!arguments.measurement.empty()) {
    const robots::RobotEstimate estimate =
        inferEstimate(arguments.experiment.file, arguments.measurement, arguments.start, arguments.known);
    twinmap::view::addMotion(experiment, makePoint(experiment.model, estimate.getMeans()),
                             "updated (" + estimate.status + ")", scene);
  }
  if (!arguments.svg.empty()) {
    writeTextFile(arguments.svg, twinmap::view::makePicture(scene));
    std::cerr << arguments.svg << ": the mechanism as it begins\n";
  }
  const std::string out = !arguments.out.empty() ? arguments.out : experiment.name.text + ".html";
  if (!arguments.out.empty() || arguments.svg.empty()) {
    writeTextFile(out, twinmap::view::makePage(scene));
    std::cerr << out << ": the mechanism, moving; open it in a browser\n";
  }
}

}  // namespace twinmap::cli
