#include "framework/study/replay/write_replay.hpp"

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/study/replay/replay_files.hpp"
#include "framework/study/replay/replay_page.hpp"

namespace twinmap {

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

}  // namespace twinmap
