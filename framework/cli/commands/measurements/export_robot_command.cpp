#include <fmt/core.h>

#include <filesystem>
#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/infer_estimate.hpp"
#include "framework/cli/commands/robot_file.hpp"
#include "framework/robots/estimate_file.hpp"

namespace twinmap::cli {
namespace {

namespace fs = std::filesystem;
using robots::RobotEstimate;

/// Draws until so many robots that exist are written: those beyond a physical limit are drawn again.
void writeDraws(const robots::XmlFile& file, const robots::Robot& robot, const RobotEstimate& estimate,
                const RobotExportArguments& arguments) {
  const fs::path folder = arguments.draws_folder;
  makeFolders(folder);
  const robots::EstimateDraws draws(estimate);
  const int most = 100 * arguments.draws;
  std::string csv = "file";
  for (const std::string& name : estimate.names) {
    csv += "," + name;
  }
  int written = 0;
  for (int number = 0; number < most && written < arguments.draws; ++number) {
    const std::map<std::string, double> values = draws.draw(number);
    const robots::RobotValues placed = robots::placeValues(robot, values, estimate.source);
    if (!placed.exist) {
      continue;
    }
    const std::string name = fmt::format("{:05}{}", ++written, isMjcf(file) ? ".xml" : ".urdf");
    writeTextFile(folder / name, writeRobot(file, robot, placed));
    csv += "\n" + name;
    for (const std::string& parameter : estimate.names) {
      csv += "," + toText(values.at(parameter));
    }
  }
  if (written < arguments.draws) {
    throw std::runtime_error(
        fmt::format("only {} of {} draws are of a robot that exists: the estimate says too little of "
                    "its masses; give priors, or fewer parameters",
                    written, most));
  }
  writeTextFile(folder / "draws.csv", csv + "\n");
  std::cout << fmt::format("{}: {} files, draws.csv\n", folder.string(), written);
}

}  // namespace

void exportRobot(const RobotExportArguments& arguments) {
  if (arguments.out.empty() && arguments.draws == 0) {
    throw ExperimentError("export --urdf: give --out FILE or --draws N DIR");
  }
  const robots::XmlFile file(arguments.robot);
  const robots::Robot robot = readRobot(file);
  const RobotEstimate estimate =
      arguments.measurement.empty()
          ? robots::readEstimate(readBytes(arguments.estimate), arguments.estimate)
          : inferEstimate(arguments.estimate, arguments.measurement, arguments.start, arguments.known);
  if (!arguments.anyway) {
    robots::requireOk(estimate);
  }
  const robots::RobotValues values = robots::placeValues(robot, estimate.getMeans(), estimate.source);
  if (!values.exist) {
    throw ExperimentError(estimate.source +
                          ": a mass or a spread is not above 0, or a loss below it: no robot has "
                          "these numbers");
  }
  if (!arguments.out.empty()) {
    const fs::path json = fs::path(arguments.out).replace_extension(".json");
    writeTextFile(arguments.out, writeRobot(file, robot, values));
    writeTextFile(json, robots::makeUpdateJson(estimate, values.without_place));
    std::cout << fmt::format("{}: {} with what was estimated; values and sds: {}\n", arguments.out,
                             arguments.robot, json.string());
  }
  if (arguments.draws > 0) {
    writeDraws(file, robot, estimate, arguments);
  }
}

}  // namespace twinmap::cli
