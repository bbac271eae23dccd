#include <filesystem>
#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/replay_measurement.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/inference/text/inference_text.hpp"
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

fs::path chooseFolder(const ReplayArguments& arguments) {
  if (!arguments.out.empty()) {
    return arguments.out;
  }
  const fs::path run =
      fs::is_directory(arguments.run) ? fs::path(arguments.run) : fs::path(arguments.run).parent_path();
  return run / "replay" / fs::path(arguments.file).stem();
}

}  // namespace

void replay(const ReplayArguments& arguments) {
  WaitingLine waiting("replay " + nameWindow(arguments.file, arguments.start));
  const InferenceSource source(arguments.run);
  const Replay replay = replayMeasurement(source, arguments);
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
