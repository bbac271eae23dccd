#include <iostream>

#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/robots/experiment_text.hpp"
#include "framework/robots/urdf/read_urdf.hpp"

namespace twinmap::cli {

void importRobot(const ImportArguments& arguments) {
  robots::Robot robot = robots::readUrdf(robots::XmlFile(arguments.file));
  robots::ImportOptions options;
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
