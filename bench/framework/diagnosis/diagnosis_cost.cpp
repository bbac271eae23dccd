// What the score test of a diagnosis costs:
//   diagnosis_cost FILE.yaml ...
// prints for each file the milliseconds of a processor that one test of all candidates takes, the median of
// several: of those without states and scans of their scales, then of all.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/tolerances/tolerances.hpp"

namespace twinmap {
namespace {

struct Cost {
  std::size_t candidates = 0;
  double milliseconds = 0.0;
};

Cost measure(const ExperimentSpec& experiment, CandidateKinds kinds) {
  constexpr int kRuns = 7;
  const ResponseLayout layout = makeLayout(experiment);
  const FeatureExtractor extractor = makeExtractor(experiment, layout);
  const RecordedFeatures zero{layout, {Eigen::VectorXd::Zero(extractor.getFeatureCount())}, {}};
  const Eigen::VectorXd center = calcBoxCenter(collectUnknown(experiment.model));
  Cost cost;
  std::vector<double> times;
  for (int run = 0; run < kRuns; ++run) {
    const std::clock_t begin = std::clock();
    cost.candidates = scoreCandidates(experiment, zero, center, {kinds}).candidates.size();
    times.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::sort(times.begin(), times.end());
  cost.milliseconds = times[times.size() / 2];
  return cost;
}

void print(const char* file) {
  const ExperimentSpec experiment = followNoise(readExperimentWithSignals(loadExperimentTree(file)));
  const Cost plain = measure(experiment, CandidateKinds::kWithoutStates);
  const Cost all = measure(experiment, CandidateKinds::kAll);
  fmt::print("{:55} without states {:3} {:6.1f} ms, all {:3} {:7.1f} ms\n", file, plain.candidates,
             plain.milliseconds, all.candidates, all.milliseconds);
}

}  // namespace
}  // namespace twinmap

int main(int count, char** arguments) {
  for (int i = 1; i < count; ++i) {
    twinmap::print(arguments[i]);
  }
  return 0;
}
