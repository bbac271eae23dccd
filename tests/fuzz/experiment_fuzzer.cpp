// Feeds any bytes to the reader of experiment files: they are refused with an ExperimentError, or the
// experiment as resolved reads as itself.
#include "framework/experiment/files/experiment_file.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace twinmap;

void requireSame(const std::string& text, const std::string& again) {
  require(text == again, "the resolved experiment does not check as itself", text + "\nbut as:\n" + again);
}

std::string resolve(const std::string& text) {
  return writeExperiment(readExperiment(parseYaml(text, "resolved.yaml")));
}

/// What `twinmap check` prints.
std::string check(const YamlNode& tree) {
  const std::string resolved = writeExperiment(readExperiment(tree));
  return readSweep(tree) ? writeIndependentDefaults(tree) : resolved;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::string resolved, swept;
  try {
    const YamlNode tree = parseYaml(text, "experiment.yaml");
    swept = check(tree);
    resolved = writeExperiment(readExperiment(tree));
  } catch (const ExperimentError& error) {
    require(std::string(error.what()).find("experiment.yaml") != std::string::npos ||
                std::string(error.what()).find("command line") != std::string::npos,
            "an error without a place", error.what());
    return 0;
  }
  requireSame(resolved, resolve(resolved));  // throws what nobody catches, if it is refused
  requireSame(resolved, writeExperiment(readResolved(resolved)));
  requireSame(swept, check(parseYaml(swept, "swept.yaml")));
  return 0;
}
