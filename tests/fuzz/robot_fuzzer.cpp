// Feeds any bytes to the reader of URDFs: they are refused with an ExperimentError that names the file, or
// become an experiment that reads, and the file is written back as it was.
#include <unistd.h>

#include <fstream>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/robots/experiment_text.hpp"
#include "framework/robots/urdf/read_urdf.hpp"
#include "framework/robots/urdf/write_urdf.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace twinmap;

/// In memory, one of each process.
const std::string& getPath() {
  static const std::string path = "/dev/shm/robot-fuzzer-" + std::to_string(getpid()) + ".urdf";
  return path;
}

/// By the text's length, so that all are tried.
robots::ImportOptions chooseOptions(std::size_t size) {
  robots::ImportOptions options;
  options.base = size % 2 == 0 ? robots::Base::kFixed : robots::Base::kFree;
  options.from_motion = size % 5 == 0;
  options.stops = size % 3 == 0 && !options.from_motion;  // the command refuses both
  if (size % 7 < 5) {
    options.parameters = {"inertia", "damping"};
  }
  return options;
}

/// An experiment's text; "" where the robot is refused.
std::string import(std::size_t size) {
  try {
    const robots::XmlFile file(getPath());
    robots::Robot robot = robots::readUrdf(file);
    const std::string written = robots::writeUrdf(file, robot, {});
    require(written == file.getText(), "the file is not written back as it was", written);
    return robots::makeExperimentText(robot, chooseOptions(size));
  } catch (const ExperimentError& error) {
    require(std::string(error.what()).find(getPath()) != std::string::npos, "an error without the file",
            error.what());
    return "";
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  std::ofstream(getPath(), std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<long>(size));
  if (const std::string text = import(size); !text.empty()) {
    try {
      readExperiment(parseYaml(text, "robot.yaml"));
    } catch (const ExperimentError& error) {
      require(false, error.what(), text);
    }
  }
  return 0;
}
