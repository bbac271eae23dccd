#include <iostream>

#include "framework/cli/commands/commands.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/look.hpp"

namespace twinmap::cli {

void look(const LookArguments& arguments) {
  TimeBase base;
  if (!arguments.time.empty()) {
    base.time = parseColumn(arguments.time, {"--time", 0, 0, ""});
  }
  if (arguments.sample_rate > 0.0) {
    base.sample_rate = arguments.sample_rate;
  }
  const TableLook looked = twinmap::look(readTable(arguments.measurement, {}, MissingCells::kKeep), base);
  std::cout << (arguments.json ? makeLookJson(looked) : makeLookText(looked));
}

}  // namespace twinmap::cli
