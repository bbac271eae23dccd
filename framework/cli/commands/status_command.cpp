#include <iostream>

#include "framework/cli/commands/commands.hpp"
#include "framework/study/shards/submission.hpp"
#include "framework/study/sweep/sweep_status.hpp"

namespace twinmap::cli {

void status(const StatusArguments& arguments) {
  std::cout << describeStatus(readStatus(arguments.folder, arguments.store))
            << describeSubmission(arguments.folder);
}

}  // namespace twinmap::cli
