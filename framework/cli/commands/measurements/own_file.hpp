#pragma once

#include <string>

namespace twinmap::cli {

/// How a user gets the experiment file of one trial.
inline std::string describeOwnFile() {
  return "write the trial's own file by twinmap check FILE trial=NAME > NAME.yaml";
}

}  // namespace twinmap::cli
