#include <iostream>

#include "framework/cli/commands/commands.hpp"
#include "framework/results/comparison_text.hpp"

namespace twinmap::cli {

void compare(const CompareArguments& arguments) {
  const RunComparison comparison =
      compareRuns(readComparedRun(arguments.folder_a), readComparedRun(arguments.folder_b));
  std::cout << (arguments.csv    ? makeComparisonCsv(comparison)
                : arguments.json ? makeComparisonJson(comparison)
                                 : makeComparisonText(comparison));
}

}  // namespace twinmap::cli
