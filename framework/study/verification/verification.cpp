#include "framework/study/verification/verification.hpp"

#include <algorithm>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/temporary_folder.hpp"
#include "framework/base/random/slices.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/store/finished_run.hpp"
#include "framework/store/provenance.hpp"
#include "framework/store/samples_file.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/verification/file_difference.hpp"
#include "framework/study/verification/result_checks.hpp"
#include "framework/study/verification/sample_checks.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

void verifyPart(const ExperimentSpec& experiment, const VerifyOptions& options, Verification& verification) {
  requireAllSamples(experiment, "a verification of some samples ('twinmap verify' without --all)");
  const std::unique_ptr<Simulator> made =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  const Simulator& simulator = *made;
  const ChosenSamples chosen{chooseSome(options.samples, experiment.design.train.samples, options.seed, 0),
                             chooseSome(options.samples, experiment.design.test.samples, options.seed, 1)};
  try {
    const SimulatedSets sets = checkSamples(experiment, simulator, chosen, options.threads, verification);
    checkResults(experiment, simulator, sets, chosen.test, options.threads, verification);
  } catch (const UnreadableSamples& error) {
    verification.checks.push_back({"samples.h5: can be read", error.what()});
    verification.notes.emplace_back("the other files are not compared, for they follow from samples.h5");
  }
}

/// With the number of training samples that the run took, where that is automatic.
ExperimentSpec takeRecordedSamples(const ExperimentSpec& experiment, const fs::path& folder) {
  return experiment.design.train.samples.automatic
             ? takeTrainingSamples(experiment, countTrainingSamples(folder / "samples.h5"))
             : experiment;
}

/// All files of a run that follow from its experiment alone.
std::vector<fs::path> listResults(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path file = entry.path().lexically_relative(folder);
    const bool of_one_run = file == "provenance.json" || file == "report.html" || file == "lock" ||
                            file.extension() == ".log" || *file.begin() == "chunks" ||
                            *file.begin() == "figures";
    if (entry.is_regular_file() && !of_one_run) {
      files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void verifyAll(const ExperimentSpec& experiment, const VerifyOptions& options, Verification& verification) {
  const TemporaryFolder temporary;
  RunOptions run;
  run.folder = temporary.getPath();
  run.train_samples = countTrainingSamples(verification.folder / "samples.h5");
  RunControl control;
  control.threads = options.threads;
  runExperiment(experiment, run, control);
  for (const fs::path& file : listResults(run.folder)) {
    verification.check(file.string(),
                       [&] { return findFileDifference(verification.folder / file, run.folder / file); });
  }
}

}  // namespace

std::vector<int> chooseSome(int count, int total, std::uint64_t seed, int stream) {
  std::vector<int> chosen = makePermutation(total, {seed, RandomPurpose::kVerification}, stream);
  chosen.resize(std::min(count, total));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Verification verifyRun(const fs::path& folder, const VerifyOptions& options) {
  requireFinishedRun(folder, {"samples.h5", "predictions.csv", "metrics.csv"});
  Verification verification;
  verification.folder = folder;
  const std::string provenance = readBytes(folder / "provenance.json");
  verification.build_differences = listBuildDifferences(provenance);
  verification.check("files: digests in provenance.json",
                     [&] { return findChangedFile(provenance, folder); });
  const ExperimentSpec experiment = loadExperiment((folder / "resolved.yaml").string());
  if (!experiment.inverse_map.isNone()) {
    requireFinishedRun(folder, {"maps.h5"});
  }
  if (options.all || experiment.inverse_map.isNone()) {  // posteriors take as long as the run
    verifyAll(experiment, options, verification);
  } else {
    verifyPart(takeRecordedSamples(experiment, folder), options, verification);
  }
  return verification;
}

}  // namespace twinmap
