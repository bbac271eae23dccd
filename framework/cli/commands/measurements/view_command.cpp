#include <filesystem>
#include <iostream>
#include <optional>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/replay_measurement.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/models/make_simulator.hpp"
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

Eigen::VectorXd findCenter(const ExperimentSpec& experiment) {
  return calcBoxCenter(collectSampled(experiment.model));
}

/// What was measured beside the nominal model, which is not fitted.
struct Unfitted {
  Unfitted(const MeasurementReader& reader, const Table& table, const std::optional<double>& start)
      : experiment(reader.getExperiment()),
        layout(reader.getLayout()),
        measured(reader.readAvailableFeatures(table, start).response),
        noise_stddev(calcNoiseStddev(experiment.noise, layout)) {}

  /// The model's own response; NaN where it fails.
  Eigen::VectorXd simulate() const {
    Eigen::MatrixXd response(layout.getRowCount(), 1);
    SampleStatus status;
    makeTrustedSimulator(experiment.model, layout.times, layout.modes)
        ->simulate(Eigen::MatrixXd(findCenter(experiment)), response, &status);
    return response.col(0);
  }

  ExperimentSpec experiment;  ///< with the excitation of the measurement
  ResponseLayout layout;
  Eigen::VectorXd measured, noise_stddev;
};

Unfitted readUnfitted(const ViewArguments& arguments, const ExperimentSpec& experiment) {
  const MeasurementReader reader(experiment);
  const Table table = readTable(arguments.measurement, reader.listColumns(), MissingCells::kKeep);
  std::optional<ExperimentSpec> followed = reader.follow(table, arguments.start);
  return followed ? Unfitted(MeasurementReader(std::move(*followed)), table, arguments.start)
                  : Unfitted(reader, table, arguments.start);
}

/// A fit asks terms at each joint, each by equations of all bodies: of more it takes minutes to hours.
constexpr std::size_t kMostFitted = 30;

/// Draws the model, with a measurement before and after it, which is inferred once.
class SceneMaker {
 public:
  SceneMaker(const ViewArguments& arguments, const ExperimentSpec& experiment) : experiment_(experiment) {
    if (arguments.measurement.empty()) {
      return;
    }
    if (experiment.model.system.bodies.size() > kMostFitted) {
      std::cerr << "warning: of more than " << kMostFitted
                << " bodies the model is not fitted to be drawn: what was measured moves beside the nominal "
                   "one; fit "
                   "it by infer\n";
      unfitted_ = readUnfitted(arguments, experiment);
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
    return replay_     ? makeMeasured(frames)
           : unfitted_ ? makeUnfitted(frames)
                       : makeNominal(experiment_, frames);
  }

  double getDuration() const {
    const ExperimentSpec& drawn = replay_     ? replay_->experiment
                                  : unfitted_ ? unfitted_->experiment
                                              : experiment_;
    return drawn.model.simulation.duration;
  }

 private:
  static Scene makeNominal(const ExperimentSpec& experiment, int frames) {
    return twinmap::view::makeScene(experiment, findCenter(experiment), "nominal", frames);
  }

  Scene makeUnfitted(int frames) const {
    const Unfitted& all = *unfitted_;
    Scene scene = makeNominal(all.experiment, frames);
    twinmap::view::addMeasurement(all.experiment, findCenter(all.experiment),
                                  {all.layout, all.measured, all.simulate(), all.noise_stddev}, scene);
    return scene;
  }

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
  std::optional<Unfitted> unfitted_;
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
