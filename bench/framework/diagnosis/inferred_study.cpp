// How often an inference keeps silent of a term that its model lacks:
//   inferred_study FILE.yaml [tests] [terms] [seed]
// simulates measurements of machines drawn from the bounds that have one term more than the model, of 1
// to 1.3 times its chi-square after the best fit without it, so that noise alone explains most of them. Each
// is inferred as `twinmap infer FILE.yaml` does and diagnosed. Counted are those in which the diagnosis has
// log evidence above 5 for a term that moves a parameter by more than its standard deviation, and of these
// the ones whose status is silent; and, with nothing missing, the ones in which a term is named ("alarms").
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "bench/framework/diagnosis/incomplete_machine.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/inference/measurement/direct_inference.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;

constexpr Ratios kHidden{1.0, 1.3};

/// Whether a diagnosis has evidence that an inference must not keep silent of.
bool speaks(const Diagnosis& diagnosis) {
  constexpr double kEvidence = 5.0;
  if (diagnosis.found == 0) {
    return false;
  }
  const TermFinding& first = diagnosis.steps.front().ranked.front();
  return first.log_evidence > kEvidence && first.shifts.cwiseAbs().maxCoeff() > 1.0;
}

class Study {
 public:
  Study(const std::string& file, std::uint64_t seed)
      : maker_(file, seed, kHidden), reader_(maker_.getModel()), inference_(reader_) {}

  const MachineMaker& getMaker() const { return maker_; }

  struct Tally {
    int measured = 0, speaking = 0, silent = 0, named = 0;
    std::map<std::string, int> statuses;
  };

  void run(const std::string& term, int test, Tally& tally) {
    const std::optional<IncompleteMachine> machine = maker_.make(term, test);
    const std::optional<VectorXd> measured =
        machine ? maker_.measure(machine->experiment, machine->point, test, 0) : std::optional<VectorXd>();
    if (!measured) {
      return;
    }
    const RecordedFeatures recording{maker_.getLayout(), {*measured}, {}};
    InferredMeasurement inferred = inference_.infer(*measured, {});
    testModel(maker_.getModel(), recording, inferred);
    const bool speaking = term != "none" && speaks(diagnose(maker_.getModel(), recording, {}));
    const std::vector<std::string> statuses = listStatuses(inferred);
    const bool named = statuses.front() == "missing_term" || isMismatch(statuses) ||
                       (statuses.front() == "sensor_offset" && term.rfind("offset.", 0) == 0);
    ++tally.measured;
    tally.speaking += speaking ? 1 : 0;
    tally.silent += speaking && !named ? 1 : 0;
    tally.named += inferred.findMissing() != nullptr ? 1 : 0;
    ++tally.statuses[joinStatuses(statuses, "+")];
    if (speaking && !named) {
      fmt::print("  silent: {} test {} {}\n", term, test, joinStatuses(statuses, "+"));
    }
  }

 private:
  const MachineMaker maker_;
  const MeasurementReader reader_;
  DirectInference inference_;
};

void print(const char* what, const Study::Tally& tally) {
  std::string statuses;
  for (const auto& [status, count] : tally.statuses) {
    statuses += fmt::format(" {} {}", status, count);
  }
  fmt::print("{}: {} measured, {} of which a diagnosis speaks, {} silent, {} named;{}\n", what,
             tally.measured, tally.speaking, tally.silent, tally.named, statuses);
  std::fflush(stdout);
}

int run(int count, char** arguments) {
  if (count < 2) {
    fmt::print("usage: inferred_study FILE.yaml [tests] [terms] [seed]\n");
    return 2;
  }
  const auto read = [&](int i, int otherwise) { return count > i ? std::atoi(arguments[i]) : otherwise; };
  const int tests = read(2, 2);
  const auto most = static_cast<std::size_t>(read(3, 8));
  Study study(arguments[1], static_cast<std::uint64_t>(read(4, 1)));
  std::vector<std::string> terms = study.getMaker().listTerms();
  terms.erase(std::remove_if(terms.begin(), terms.end(),
                             [](const std::string& term) { return term == "none" || isProcess(term); }),
              terms.end());
  Study::Tally lacking, sound;
  for (std::size_t i = 0; i < std::min(most, terms.size()); ++i) {
    for (int test = 0; test < tests; ++test) {
      study.run(terms[i * terms.size() / std::min(most, terms.size())], 1000 * static_cast<int>(i) + test,
                lacking);
      study.run("none", 100000 + 1000 * static_cast<int>(i) + test, sound);
    }
  }
  fmt::print("{}\n", arguments[1]);
  print("  a term is missing", lacking);
  print("  nothing is missing (alarms: named)", sound);
  return 0;
}

}  // namespace
}  // namespace twinmap

int main(int count, char** arguments) {
  try {
    return twinmap::run(count, arguments);
  } catch (const std::exception& error) {
    fmt::print("{}: {}\n", count > 1 ? arguments[1] : "", error.what());
    return 1;
  }
}
