#pragma once

#include <string>
#include <vector>

namespace twinmap::cli {

/// What an option or an argument takes, as shells complete it.
enum class Taken { kNothing, kFile, kFolder, kOther };

struct OptionDescription {
  std::vector<std::string> names;  ///< "--out", with their dashes
  std::string description;
  std::string value;  ///< "DIR"; empty for a flag
  Taken taken = Taken::kNothing;
};

struct CommandDescription {
  std::string name;
  std::string description;
  std::vector<OptionDescription> options;
  std::vector<OptionDescription> arguments;  ///< by position; names: one, "FILE"
};

/// A script that completes the command line of `twinmap`: its commands, their options, files and folders.
/// shell: "bash", "zsh" or "fish". Throws std::invalid_argument for another.
std::string makeCompletion(const std::string& shell, const std::vector<CommandDescription>& commands);

}  // namespace twinmap::cli
