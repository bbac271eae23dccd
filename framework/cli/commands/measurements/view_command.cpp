#include <filesystem>
#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/replay_measurement.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/view/make_scene.hpp"
#include "framework/view/measured.hpp"
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

using twinmap::view::Scene;

/// The measurement beside the model before and after it.
Scene makeMeasuredScene(const ViewArguments& arguments) {
  ReplayArguments asked;
  asked.run = arguments.experiment.file;
  asked.file = arguments.measurement;
  asked.start = arguments.start;
  asked.known = arguments.known;
  asked.draws = 2;  // of the band, which is not drawn
  const Replay replay = replayMeasurement(InferenceSource(asked.run), asked);
  const std::vector<std::string> statuses = selectEstimate(replay.inferred).statuses;
  const std::string status = statuses.empty() ? "not judged" : statuses.front();
  Scene scene = twinmap::view::makeScene(replay.experiment, replay.nominal.point, "nominal");
  twinmap::view::addMotion(replay.experiment, replay.updated.point, "updated (" + status + ")", scene);
  twinmap::view::addMeasurement(
      replay.experiment, replay.updated.point,
      {replay.layout, replay.measured, replay.updated.response, replay.noise_stddev}, scene);
  return scene;
}

Scene makeNominalScene(const ExperimentSpec& experiment) {
  return twinmap::view::makeScene(experiment, calcBoxCenter(collectSampled(experiment.model)), "nominal");
}

}  // namespace

void view(const ViewArguments& arguments) {
  const ExperimentSpec experiment = loadExperiment(arguments.experiment);
  requireOneTrial(experiment, "a picture is of one");
  const Scene scene =
      arguments.measurement.empty() ? makeNominalScene(experiment) : makeMeasuredScene(arguments);
  for (const std::string& remark : scene.remarks) {
    std::cerr << "warning: " << remark << "\n";
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
