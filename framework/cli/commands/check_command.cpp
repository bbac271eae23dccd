#include <fmt/core.h>

#include <iostream>
#include <set>
#include <sstream>

#include "framework/cli/commands/commands.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/check/unused_parameters.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/jumps.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/models/model_remarks.hpp"
#include "framework/study/sweep/model_groups.hpp"

namespace twinmap::cli {
namespace {

/// "[0, 0.1, 0.2, ...]" as "[4000 values, 0 .. 7.985]" where it is longer than a reader takes in.
std::string abbreviateList(const std::string& list) {
  constexpr auto kMax = 20;
  const auto count = std::count(list.begin(), list.end(), ',') + 1;
  const std::size_t last = list.rfind(' ') + 1;
  return count <= kMax ? list
                       : fmt::format("[{} values, {} .. {}]", count, list.substr(1, list.find(',') - 1),
                                     list.substr(last, list.size() - last - 1));
}

/// A line with each list of numbers in it abbreviated.
std::string abbreviate(const std::string& line) {
  std::string shown;
  std::size_t copied = 0;
  for (std::size_t begin = line.find('['); begin != std::string::npos; begin = line.find('[', begin + 1)) {
    const std::size_t end = line.find_first_not_of("0123456789+-.e, ", begin + 1);
    if (end != std::string::npos && line[end] == ']') {
      shown += line.substr(copied, begin - copied) + abbreviateList(line.substr(begin, end + 1 - begin));
      copied = end + 1;
    }
  }
  return shown + line.substr(copied);
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
  std::set<std::string> engines, remarks;
  std::vector<std::string> machine;  // of the first model: those of a sweep are alike
  for (const ModelGroup& group : groupByModel(expandCasesWithSignals(tree))) {  // what is wrong in any case
    const std::unique_ptr<Simulator> simulator = makeSimulator(group.model, group.times, group.modes);
    simulator->checkStart();
    engines.insert(simulator->describeEngine());
    for (const std::string& jump : listJumps(group.model.system)) {
      remarks.insert("steps become small: " + jump);
    }
    for (const std::string& angle : listDegrees(group.model)) {
      remarks.insert(angle);
    }
    machine = machine.empty() ? simulator->describeModel() : machine;
  }
  for (const std::string& unused : listUnusedParameters(tree)) {
    std::cout << "# " << unused << '\n';
  }
  for (const std::string& remark : remarks) {
    std::cout << "# " << remark << '\n';
  }
  for (const std::string& engine : engines) {
    std::cout << "# solver: " << engine << '\n';
  }
  for (const std::string& line : machine) {
    std::cout << "#   " << line << '\n';
  }
  if (readExperiment(tree).inverse_map.isNone()) {
    std::cout << "# no inverse map: measurements are inferred by their posterior on the simulator\n";
  }
  if (!arguments.svg.empty()) {
    ViewArguments picture;
    picture.experiment = arguments.experiment;
    picture.svg = arguments.svg;
    view(picture);
  }
  const std::string text = tree.find("sweep") == nullptr ? writeExperiment(readExperimentWithSignals(tree))
                                                         : writeIndependentDefaults(tree);
  std::cout << (arguments.full ? text : abbreviateTables(text));
}

}  // namespace twinmap::cli
