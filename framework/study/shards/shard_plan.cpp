#include "framework/study/shards/shard_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/json/json.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/results/run_state.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/sweep/run_sweep.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxShards = 1000;  // Slurm's MaxArraySize is 1001 where nobody has changed it
constexpr ShardKind kKinds[] = {ShardKind::kSimulate, ShardKind::kCases, ShardKind::kFinish};

/// Consecutive ranges with as many of the wanted items each, give or take one.
void cut(const std::vector<bool>& wanted, ShardKind kind, int parts, std::vector<Shard>& shards) {
  const auto total = static_cast<int>(std::count(wanted.begin(), wanted.end(), true));
  parts = std::min(parts, total);
  int first = 0, passed = 0, part = 0;
  for (int i = 0; i < static_cast<int>(wanted.size()); ++i) {
    passed += wanted[static_cast<std::size_t>(i)] ? 1 : 0;
    if (part < parts && passed >= (std::int64_t(part) + 1) * total / parts) {
      const int last = ++part == parts ? static_cast<int>(wanted.size()) : i + 1;
      shards.push_back({kind, first, last});
      first = last;
    }
  }
}

int chooseParts(double seconds, const ShardOptions& options) {
  const double parts = std::ceil(seconds / (options.seconds * options.threads));
  return static_cast<int>(std::clamp(parts, 1.0, double(kMaxShards)));
}

}  // namespace

int ShardPlan::count(ShardKind kind) const {
  return static_cast<int>(
      std::count_if(shards.begin(), shards.end(), [&](const Shard& shard) { return shard.kind == kind; }));
}

const char* getName(ShardKind kind) {
  constexpr const char* kNames[] = {"simulate", "cases", "finish"};
  return kNames[static_cast<std::size_t>(kind)];
}

fs::path getClusterFolder(const fs::path& folder) {
  return folder / "cluster";
}

ExperimentSurvey surveyForShards(const YamlNode& root, const ResultPlace& place) {
  std::vector<SweepCase> cases = expandCasesWithSignals(root);
  followNoise(cases);
  limitAutomaticSamples(cases);
  ExperimentSurvey survey = surveyCases(std::move(cases), place);
  measureTimes(survey);
  return survey;
}

ShardPlan makeShardPlan(const ExperimentSurvey& survey, const ShardOptions& options) {
  ShardPlan plan;
  plan.store = fs::absolute(getStoreRoot(options.place.folder, options.place.store));
  plan.computed_with = describeComputation();
  plan.portable = std::all_of(survey.cases.begin(), survey.cases.end(),
                              [](const SweepCase& one) { return one.experiment.model.simulation.portable; });
  for (const SweepCase& one : survey.cases) {
    plan.train_samples.push_back(one.experiment.design.train.samples.number);
  }
  PlanOptions one_thread;
  const SweepPlan costs = planRun(survey, one_thread);
  plan.simulate_s = costs.simulate_s;
  plan.cases_s = costs.cases_s;
  plan.memory = planRun(survey, {options.threads, one_thread.memory}).memory;
  const std::vector<bool>& lacking = survey.stored.lacking;
  plan.missing = static_cast<int>(std::count(lacking.begin(), lacking.end(), true));
  cut(lacking, ShardKind::kSimulate,
      options.simulate_shards > 0 ? options.simulate_shards : chooseParts(plan.simulate_s, options),
      plan.shards);
  std::vector<bool> incomplete = survey.complete;
  incomplete.flip();
  cut(incomplete, ShardKind::kCases, chooseParts(plan.cases_s, options), plan.shards);
  plan.shards.push_back({ShardKind::kFinish, 0, 0});
  return plan;
}

std::vector<SweepCase> expandPlannedCases(const YamlNode& root, const ShardPlan& plan) {
  std::vector<SweepCase> cases = expandCasesWithSignals(root);
  if (cases.size() != plan.train_samples.size()) {
    throw ExperimentError("cluster/plan.json: is of another experiment than resolved.yaml; submit it again");
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i].experiment.design.train.samples.number = plan.train_samples[i];
  }
  followNoise(cases);
  return cases;
}

void writeShardPlan(const fs::path& folder, const ShardPlan& plan) {
  Json shards = Json::array();
  for (const Shard& shard : plan.shards) {
    shards.push_back({{"kind", getName(shard.kind)}, {"first", shard.first}, {"last", shard.last}});
  }
  const Json root = {{"store", plan.store.string()},
                     {"computed_with", plan.computed_with},
                     {"portable", plan.portable},
                     {"train_samples", plan.train_samples},
                     {"missing_samples", plan.missing},
                     {"simulate_s", plan.simulate_s},
                     {"cases_s", plan.cases_s},
                     {"memory_bytes", plan.memory},
                     {"shards", shards}};
  writeTextFile(getClusterFolder(folder) / "plan.json", formatJson(root, 1) + "\n");
}

ShardPlan readShardPlan(const fs::path& folder) {
  const fs::path file = getClusterFolder(folder) / "plan.json";
  if (!fs::exists(file)) {
    throw ExperimentError(folder.string() + ": was not submitted: it has no cluster/plan.json");
  }
  const Json root = parseJson(readBytes(file));
  ShardPlan plan;
  plan.store = root.at("store").get<std::string>();
  plan.computed_with = root.at("computed_with");
  plan.portable = root.at("portable");
  plan.train_samples = root.at("train_samples").get<std::vector<int>>();
  plan.missing = root.at("missing_samples");
  plan.simulate_s = root.at("simulate_s");
  plan.cases_s = root.at("cases_s");
  plan.memory = root.at("memory_bytes");
  for (const Json& shard : root.at("shards")) {
    const auto* kind = std::find_if(std::begin(kKinds), std::end(kKinds), [&](ShardKind one) {
      return shard.at("kind").get<std::string>() == getName(one);
    });
    plan.shards.push_back({*kind, shard.at("first"), shard.at("last")});
  }
  return plan;
}

}  // namespace twinmap
