#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/fmi/variables_table.hpp"

namespace twinmap::cli {

void printVariables(const std::string& file) {
  std::cout << fmi::makeVariablesTable(file);
}

}  // namespace twinmap::cli
