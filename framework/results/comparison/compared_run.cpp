#include "framework/results/comparison/compared_run.hpp"

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/store/finished_run.hpp"

namespace twinmap {

ComparedRun readComparedRun(const std::filesystem::path& folder) {
  requireFinishedRun(folder, {"predictions.csv"});
  const std::string resolved = (folder / "resolved.yaml").string();
  ComparedRun run{folder.string(), loadYaml(resolved), loadExperiment(resolved).model.parameters, {}};
  run.test = readPredictionsFile(folder / "predictions.csv", collectNames(run.parameters));
  std::vector<int> samples = run.test.samples;
  for (const Eigen::Index repeated : run.test.predictions.repeated) {
    samples.push_back(run.test.samples[static_cast<std::size_t>(repeated)]);
  }
  run.test.predictions.mixtures =
      readComponentsFile(folder / "components.csv", collectNames(run.parameters), samples);
  return run;
}

}  // namespace twinmap
