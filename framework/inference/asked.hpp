#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// What a command was asked for, so that the next one can be pasted; empty parts are not known.
struct Asked {
  std::string run;                    ///< folder of a run, its maps.h5, or an experiment file
  std::vector<std::string> files{};   ///< measurements
  std::vector<std::string> trials{};  ///< "NAME=FILE" instead
  std::vector<std::string> known{};   ///< "NAME=VALUE" of the inputs
  std::vector<double> starts{};       ///< times in each file that are 0 of the model; empty: the experiment's
  int draws = 0;                      ///< of the posterior; 0: the default
  bool diagnoses = false;             ///< whether the table of what the model lacks follows
};

/// "cart.yaml m.csv --start 5", quoted for a shell; FILE where no recording is known.
std::string listArguments(const Asked& asked);

/// A text whose commands ("twinmap diagnose RUN FILE.", "... FILE RECORDINGS.", "twinmap simulate FILE.")
/// name what was asked, and end where the line does; as it is where the run is not known.
std::string fillCommands(std::string text, const Asked& asked);

}  // namespace twinmap
