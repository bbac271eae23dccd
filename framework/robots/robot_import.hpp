#pragma once

#include <optional>
#include <string>

#include "framework/robots/bodies.hpp"
#include "framework/robots/chosen_parameters.hpp"
#include "framework/robots/import_options.hpp"
#include "framework/robots/recording.hpp"
#include "framework/robots/robot_names.hpp"

namespace twinmap::robots {

/// What the parts of an experiment's text share while it is written.
struct RobotImport {
  RobotImport(Robot& of, const ImportOptions& how)
      : robot(of),
        options(how),
        chosen(readChosen(how.parameters)),
        assembly(assembleBodies(of, how.base, how.joints)),
        names(of),
        parameters(names, how.relative_stddev),
        gravity(names.take("g")),
        recording(how.recording) {}

  Robot& robot;
  const ImportOptions& options;
  const Chosen chosen;
  const Assembly assembly;
  RobotNames names;
  ChosenParameters parameters;
  const std::string gravity;  ///< the parameter's name
  std::optional<Recording> recording;
};

}  // namespace twinmap::robots
