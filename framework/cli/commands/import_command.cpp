#include <iostream>
#include <string>

#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/robots/experiment_text.hpp"
#include "framework/robots/mjcf/read_mjcf.hpp"
#include "framework/robots/urdf/read_urdf.hpp"

namespace twinmap::cli {

void importRobot(const ImportArguments& arguments) {
  const robots::XmlFile file(arguments.file);
  const bool is_mjcf = std::string(file.getRoot().name()) == "mujoco";
  robots::Robot robot = is_mjcf ? robots::readMjcf(file) : robots::readUrdf(file);
  robots::ImportOptions options;
  if (is_mjcf && arguments.base == "free") {
    throw ExperimentError("--base is of a URDF: an MJCF says itself which bodies are free (freejoint)");
  }
  options.base = arguments.base == "free" ? robots::Base::kFree : robots::Base::kFixed;
  options.parameters = arguments.parameters;
  options.joints = arguments.joints;
  options.stops = arguments.stops;
  const std::string experiment = robots::makeExperimentText(robot, options);
  for (const std::string& text : robots::describeLeftOut(robot)) {
    std::cerr << "not carried over: " << text << "\n";
  }
  if (arguments.strict && !robot.left_out.empty()) {
    throw ExperimentError(robot.file +
                          ": is not carried over as a whole (see above): take what it says out, or call "
                          "import without --strict");
  }
  std::cout << experiment;
}

}  // namespace twinmap::cli
