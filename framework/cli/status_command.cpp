#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/cluster/submission.hpp"
#include "framework/sweep/sweep_status.hpp"

namespace twinmap::cli {

void status(const StatusArguments& arguments) {
  std::cout << describeStatus(readStatus(arguments.folder, arguments.store))
            << describeSubmission(arguments.folder);
}

}  // namespace twinmap::cli
