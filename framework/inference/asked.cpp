#include "framework/inference/asked.hpp"

#include <filesystem>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// The experiment file; of a run the one that it keeps.
std::string findExperimentFile(const std::string& run) {
  const fs::path folder = fs::path(run).extension() == ".h5" ? fs::path(run).parent_path() : fs::path(run);
  const fs::path resolved = folder / "resolved.yaml";
  return fs::exists(resolved) ? resolved.string() : run;
}

void replaceEach(const std::string& pattern, const std::string& replacement, std::string& text) {
  for (std::size_t at = text.find(pattern); at != std::string::npos;
       at = text.find(pattern, at + replacement.size())) {
    text.replace(at, pattern.size(), replacement);
  }
}

}  // namespace

std::string listArguments(const Asked& asked) {
  std::string text = quoteForShell(asked.run);
  for (const std::string& file : asked.files) {
    text += " " + quoteForShell(file);
  }
  for (const std::string& trial : asked.trials) {
    text += " --trial " + quoteForShell(trial);
  }
  if (asked.files.empty() && asked.trials.empty()) {
    text += " FILE";
  }
  for (const double start : asked.starts) {
    text += " --start " + toText(start);
  }
  for (const std::string& known : asked.known) {
    text += " --set " + quoteForShell(known);
  }
  return text;
}

std::string fillCommands(std::string text, const Asked& asked) {
  if (asked.run.empty()) {
    return text;
  }
  const std::string arguments = listArguments(asked);
  for (const char* command : {"diagnose", "replay"}) {
    for (const char* places : {" RUN FILE.", " FILE RECORDINGS."}) {
      const std::string begin = std::string("twinmap ") + command;
      replaceEach(begin + places, begin + " " + arguments, text);
    }
  }
  replaceEach("twinmap simulate FILE.", "twinmap simulate " + quoteForShell(findExperimentFile(asked.run)),
              text);
  return text;
}

}  // namespace twinmap
