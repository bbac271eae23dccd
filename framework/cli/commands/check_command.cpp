#include <fmt/core.h>

#include <iostream>
#include <set>
#include <sstream>

#include "framework/cli/commands/commands.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/study/sweep/model_groups.hpp"

namespace twinmap::cli {
namespace {

/// A line "key: [v, v, ...]" of a longer list of numbers as "key: [4000 values, 0 .. 7.985]"; others as they
/// are.
std::string abbreviate(const std::string& line) {
  constexpr auto kMax = 20;  // values that a reader takes in
  const std::size_t begin = line.find(": ["), end = line.rfind(']');
  const auto count = std::count(line.begin(), line.end(), ',') + 1;
  if (begin == std::string::npos || end != line.size() - 1 || count <= kMax ||
      line.find_first_not_of("0123456789+-.e, ", begin + 3) != end) {
    return line;
  }
  const std::size_t first = begin + 3, last = line.rfind(' ', end) + 1;
  return fmt::format("{}[{} values, {} .. {}]", line.substr(0, begin + 2), count,
                     line.substr(first, line.find(',', first) - first), line.substr(last, end - last));
}

std::string abbreviateTables(const std::string& text) {
  std::istringstream lines(text);
  std::string shown, abbreviated;
  bool any = false;
  for (std::string line; std::getline(lines, line);) {
    abbreviated = abbreviate(line);
    any = any || abbreviated != line;
    shown += abbreviated + '\n';
  }
  return (any ? "# long tables are abbreviated; check --full prints all values\n" : "") + shown;
}

}  // namespace

void check(const CheckArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  std::set<std::string> engines;
  for (const ModelGroup& group : groupByModel(expandCasesWithSignals(tree))) {  // what is wrong in any case
    const std::unique_ptr<Simulator> simulator = makeSimulator(group.model, group.times, group.modes);
    simulator->checkStart();
    engines.insert(simulator->describeEngine());
  }
  for (const std::string& engine : engines) {
    std::cout << "# solver: " << engine << '\n';
  }
  if (readExperiment(tree).inverse_map.isNone()) {
    std::cout << "# no inverse map: measurements are inferred by their posterior on the simulator\n";
  }
  const std::string text = tree.find("sweep") == nullptr ? writeExperiment(readExperimentWithSignals(tree))
                                                         : writeIndependentDefaults(tree);
  std::cout << (arguments.full ? text : abbreviateTables(text));
}

}  // namespace twinmap::cli
