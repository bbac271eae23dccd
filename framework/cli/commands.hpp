#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/report/gates.hpp"

namespace twinmap {

/// What every command that reads an experiment takes.
struct ExperimentArguments {
  std::string file;
  std::vector<std::string> overrides;  ///< "key.path=value"
};

struct SimulateArguments {
  ExperimentArguments experiment;  ///< parameters.NAME=VALUE among the overrides sets the point
  std::string csv;                 ///< "": standard output
  bool noise = false;
};

struct RunArguments {
  ExperimentArguments experiment;
  std::string folder;  ///< "": results/NAME
  std::string store;   ///< "": chunks in the folder
  int threads = 1;
  std::string command_line;
  bool fail_on_gates = false;
};

struct ReportArguments {
  std::vector<std::string> folders;
  std::string out;  ///< "": the run's folder; of several runs results/report
  bool fail_on_gates = false;
};

/// A gate failed and --fail-on-gates was given.
class GatesFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct CompareArguments {
  std::string folder_a, folder_b;
  bool csv = false, json = false;  ///< at most one; neither: a table for people
};

struct VerifyArguments {
  std::string folder;
  int samples = 5;
  std::uint64_t seed = 1;
  bool all = false;
  int threads = 1;
};

// One file a subcommand. Results go to stdout, progress and warnings to stderr. Each throws ExperimentError
// for wrong input and any other std::exception for a failure.

/// Validates an experiment and prints it with all defaults.
void check(const ExperimentArguments& arguments);

/// Prints the JSON schema of experiment files.
void printSchema();

/// Simulates once and writes a CSV: t, then each output by its name.
void simulate(const SimulateArguments& arguments);

/// Runs an experiment and prints its table.
void run(const RunArguments& arguments);

/// Prints two runs side by side.
void compare(const CompareArguments& arguments);

/// Writes the report of runs, or of a sweep, again.
void report(const ReportArguments& arguments);

/// Prints the gates that failed; throws GatesFailed if there are any and `fail` is set.
void requireGates(const std::vector<GateResult>& gates, bool fail);

/// Recomputes a part of a run, or all of it, and prints what differs; throws std::runtime_error if anything
/// does.
void verify(const VerifyArguments& arguments);

}  // namespace twinmap
