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
#include "framework/view/film.hpp"
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

/// Draws the model, with a measurement before and after it, which is inferred once.
class SceneMaker {
 public:
  SceneMaker(const ViewArguments& arguments, const ExperimentSpec& experiment) : experiment_(experiment) {
    if (arguments.measurement.empty()) {
      return;
    }
    ReplayArguments asked;
    asked.run = arguments.experiment.file;
    asked.file = arguments.measurement;
    asked.start = arguments.start;
    asked.known = arguments.known;
    asked.draws = 2;  // of the band, which is not drawn
    replay_ = replayMeasurement(InferenceSource(asked.run), asked);
  }

  /// `frames` as of makeScene.
  Scene make(int frames) const {
    return replay_ ? makeMeasured(frames)
                   : twinmap::view::makeScene(experiment_, calcBoxCenter(collectSampled(experiment_.model)),
                                              "nominal", frames);
  }

  double getDuration() const {
    return (replay_ ? replay_->experiment : experiment_).model.simulation.duration;
  }

 private:
  Scene makeMeasured(int frames) const {
    const Replay& replay = *replay_;
    const std::vector<std::string> statuses = selectEstimate(replay.inferred).statuses;
    const std::string status = statuses.empty() ? "not judged" : statuses.front();
    Scene scene = twinmap::view::makeScene(replay.experiment, replay.nominal.point, "nominal", frames);
    twinmap::view::addMotion(replay.experiment, replay.updated.point, "updated (" + status + ")", scene);
    twinmap::view::addMeasurement(
        replay.experiment, replay.updated.point,
        {replay.layout, replay.measured, replay.updated.response, replay.noise_stddev}, scene);
    return scene;
  }

  const ExperimentSpec& experiment_;
  std::optional<Replay> replay_;
};

void printRemarks(const Scene& scene) {
  for (const std::string& remark : scene.remarks) {
    std::cerr << "warning: " << remark << "\n";
  }
}

void writePageAndPicture(const ViewArguments& arguments, const Scene& scene) {
  printRemarks(scene);
  if (!arguments.svg.empty()) {
    writeTextFile(arguments.svg, twinmap::view::makePicture(scene));
    std::cerr << arguments.svg << ": the mechanism as it begins\n";
  }
  const bool has_page = !arguments.out.empty() || (arguments.svg.empty() && arguments.mp4.empty());
  if (has_page) {
    const std::string out = !arguments.out.empty() ? arguments.out : scene.name + ".html";
    writeTextFile(out, twinmap::view::makePage(scene));
    std::cerr << out << ": the mechanism, moving; open it in a browser\n";
  }
}

}  // namespace

void view(const ViewArguments& arguments) {
  const ExperimentSpec experiment = loadExperiment(arguments.experiment);
  requireOneTrial(experiment, "a picture is of one");
  if (!arguments.mp4.empty()) {
    twinmap::view::requireFilmWriter();
  }
  const SceneMaker maker(arguments, experiment);
  const bool has_film_alone = !arguments.mp4.empty() && arguments.out.empty() && arguments.svg.empty();
  if (!has_film_alone) {
    writePageAndPicture(arguments, maker.make(0));
  }
  if (!arguments.mp4.empty()) {
    const twinmap::view::FilmPace pace = twinmap::view::choosePace(maker.getDuration());
    const Scene scene = maker.make(pace.frames);
    if (has_film_alone) {
      printRemarks(scene);
    }
    twinmap::view::writeFilm(scene, pace.speed, arguments.mp4);
    std::cerr << arguments.mp4 << ": the mechanism, moving\n";
  }
}

}  // namespace twinmap::cli
