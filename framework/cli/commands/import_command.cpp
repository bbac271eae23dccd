#include <iostream>
#include <string>

#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/robot_file.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/experiment/column_spec.hpp"
#include "framework/experiment/expression/units.hpp"
#include "framework/robots/experiment_text.hpp"

namespace twinmap::cli {

namespace {

robots::Recording readRecording(const std::string& file) {
  const Table table = readTable(file, {}, MissingCells::kKeep);
  robots::Recording recording;
  recording.file = file;
  const Column* times = nullptr;
  for (const Column& column : table.columns) {
    const std::string text = toText(ColumnSpec{column.name, column.unit, {}});
    if (times == nullptr && (column.name == "t" || column.name == "time")) {
      times = &column;
      recording.time = text;
    } else {
      recording.columns.push_back({column.name, text});
    }
  }
  if (times == nullptr || times->values.size() < 2) {
    throw ExperimentError(file + ": has no column of times 't' or 'time': name it so");
  }
  const double seconds = calcUnitConversion(times->unit.value_or("s"), "s", {file, 0, 0, ""}).factor;
  recording.count = static_cast<int>(times->values.size());
  recording.first = seconds * times->values[0];
  recording.interval =
      seconds * (times->values[recording.count - 1] - times->values[0]) / (recording.count - 1);
  return recording;
}

}  // namespace

void importRobot(const ImportArguments& arguments) {
  const robots::XmlFile file(arguments.file);
  robots::Robot robot = readRobot(file);
  robots::ImportOptions options;
  if (isMjcf(file) && arguments.base == "free") {
    throw ExperimentError("--base is of a URDF: an MJCF says itself which bodies are free (freejoint)");
  }
  options.base = arguments.base == "free" ? robots::Base::kFree : robots::Base::kFixed;
  options.parameters = arguments.parameters;
  options.joints = arguments.joints;
  options.from_motion = arguments.from_motion;
  options.stops = arguments.stops;
  if (!arguments.csv.empty()) {
    options.recording = readRecording(arguments.csv);
  }
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
