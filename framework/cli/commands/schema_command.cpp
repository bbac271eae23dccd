#include <iostream>

#include "framework/cli/commands/commands.hpp"
#include "framework/experiment/tree/json_schema.hpp"

namespace twinmap::cli {

void printSchema() {
  std::cout << makeJsonSchema();
}

}  // namespace twinmap::cli
