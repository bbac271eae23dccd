#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/study/replay/replay.hpp"
#include "framework/study/replay/replay_files.hpp"
#include "framework/study/replay/replay_page.hpp"

namespace twinmap::cli {
namespace {

namespace fs = std::filesystem;

/// Writes replay.csv, residuals.csv, fit.csv, inference.json and report.html, each whole or not at all; makes
/// the folder. Throws std::runtime_error naming what cannot be written.
void writeReplay(const std::filesystem::path& folder, const MeasurementReader& reader, const Replay& replay) {
  makeFolders(folder);
  writeTextFile(folder / "replay.csv", makeReplayCsv(replay));
  writeTextFile(folder / "residuals.csv", makeResidualsCsv(replay));
  writeTextFile(folder / "fit.csv", makeCsv(listFits(replay)));
  writeTextFile(folder / "inference.json",
                makeInferenceJson(replay.inferred, reader.getExperiment().model.parameters,
                                  reader.getExtractor().getInfos()) +
                    "\n");
  writeTextFile(folder / "report.html", makeReplayPage(reader, replay));
}

double findStart(const MeasurementReader& reader, const std::string& file, std::optional<double> start) {
  return start || !reader.getExperiment().measurement.start.when
             ? reader.getStatedStart(start)
             : reader.getStart(readTable(file, reader.listColumns()), start);
}

ReplayOptions chooseOptions(const ReplayArguments& arguments, const InferenceSource& source) {
  const ExperimentSpec& experiment = source.getExperiment();
  ReplayOptions options;
  options.measurement = {arguments.file, findStart(source.getReader(), arguments.file, arguments.start)};
  options.from = options.measurement;
  if (!arguments.from.empty()) {
    options.from = {arguments.from, findStart(source.getReader(), arguments.from, arguments.from_start)};
  }
  options.from.start = arguments.from_start.value_or(options.from.start);
  options.known = collectKnown(experiment.model.inputs, parseKnownValues(arguments.known));
  options.refine = arguments.refine;
  options.draws = arguments.draws;
  options.threads = arguments.threads;
  return options;
}

fs::path chooseFolder(const ReplayArguments& arguments) {
  if (!arguments.out.empty()) {
    return arguments.out;
  }
  const fs::path run =
      fs::is_directory(arguments.run) ? fs::path(arguments.run) : fs::path(arguments.run).parent_path();
  return run / "replay" / fs::path(arguments.file).stem();
}

Replay replayMeasurement(const InferenceSource& source, const ReplayOptions& options) {
  try {
    return twinmap::replay(source, options);
  } catch (const MeasurementError& error) {
    throw std::runtime_error(error.what());
  }
}

/// Of the measurement that parameters are inferred from.
Asked describeAsked(const ReplayArguments& arguments) {
  const bool same = arguments.from.empty();
  const std::optional<double>& start = same ? arguments.start : arguments.from_start;
  Asked asked{arguments.run, {same ? arguments.file : arguments.from}, {}, arguments.known};
  if (start) {
    asked.starts.push_back(*start);
  }
  return asked;
}

/// Asks what the model lacks.
void testModel(const InferenceSource& source, Replay& replay) {
  const MeasurementReader& reader = source.getReader();
  const MeasuredWindow& from = replay.options.from;
  const Table table = readTable(from.file.string(), reader.listColumns(), MissingCells::kKeep);
  twinmap::testModel(reader, table, from.start, replay.options.known, replay.inferred);
}

}  // namespace

void replay(const ReplayArguments& arguments) {
  WaitingLine waiting("replay " + nameWindow(arguments.file, arguments.start));
  const InferenceSource source(arguments.run);
  Replay replay = replayMeasurement(source, chooseOptions(arguments, source));
  replay.inferred.asked = describeAsked(arguments);
  testModel(source, replay);
  const fs::path folder = chooseFolder(arguments);
  writeReplay(folder, source.getReader(), replay);
  waiting.clear();
  std::cout << describeTrust(replay.inferred, source.getExperiment().model.parameters,
                             source.getReader().getExtractor().getInfos())
            << describeMapLimit(replay.inferred, source.getExperiment().model.parameters) << "\n"
            << makeFitTable(replay);
  std::cout.flush();
  std::cerr << "Report: " << (folder / "report.html").string()
            << "\nBeside it: replay.csv, residuals.csv, fit.csv, inference.json\n";
}

}  // namespace twinmap::cli
