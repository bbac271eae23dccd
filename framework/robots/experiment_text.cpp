#include "framework/robots/experiment_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/robots/acting_text.hpp"
#include "framework/robots/body_text.hpp"
#include "framework/robots/robot_import.hpp"
#include "framework/robots/shape_text.hpp"
#include "framework/robots/yaml_text.hpp"

namespace twinmap::robots {
namespace {

class ExperimentWriter {
 public:
  ExperimentWriter(Robot& robot, const ImportOptions& options) : import_(robot, options), acting_(import_) {}

  std::string write() {
    std::string bodies;
    for (const Body& body : import_.assembly.bodies) {
      bodies += writeBody(import_, body);
      acting_.addJoint(body);
    }
    acting_.addActuators();
    acting_.addClosures();
    noteFrames();
    noteGround(import_.robot, import_.assembly);
    const std::string experiment = writeParameters() + "system:\n  gravity: " + writeGravity() +
                                   "\n  bodies:\n" + bodies + acting_.writeLists() + writeTail();
    return writeHead() + experiment;
  }

 private:
  std::string writeHead() const {
    std::string text = fmt::format("# From {} by twinmap import; lines below are of that file.\n",
                                   makeComment(import_.robot.file));
    text += import_.robot.left_out.empty() ? "# Everything in it is here.\n" : "# Not carried over:\n";
    for (const std::string& line : describeLeftOut(import_.robot)) {
      text += "#   " + makeComment(line.substr(import_.robot.file.size() + 1)) + "\n";
    }
    return text + "name: " + makeIdentifier(import_.robot.name) + "\n";
  }

  static std::string makeComment(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return text;
  }

  /// Along the file's direction; of its size is the parameter. Without gravity, it is of a planet like Earth,
  /// downwards.
  std::string writeGravity() const {
    if (!import_.robot.gravity) {
      return "[0, 0, -" + import_.gravity + "]";
    }
    const Vector direction = algebra::scale(1.0 / getGravity(), *import_.robot.gravity);
    const auto write = [&](double share) {
      return share == 0.0    ? "0"
             : share == -1.0 ? "-" + import_.gravity
                             : writeNumber(share) + "*" + import_.gravity;
    };
    return "[" + write(direction.x) + ", " + write(direction.y) + ", " + write(direction.z) + "]";
  }

  double getGravity() const {
    const double size =
        import_.robot.gravity ? std::sqrt(algebra::dot(*import_.robot.gravity, *import_.robot.gravity)) : 0.0;
    return size > 0.0 ? size : kGravity;
  }

  std::string writeGravityParameter() const {
    if (import_.robot.gravity && isZero(*import_.robot.gravity)) {
      return "";
    }
    const double size = getGravity(), reach = kGravityReach * size / kGravity;
    return fmt::format("  {}: {{bounds: [{}, {}], unit: m/s2, description: {}}}\n", import_.gravity,
                       toShortText(size - reach, 6), toShortText(size + reach, 6),
                       import_.robot.gravity ? "gravity" : "gravity is not in a URDF");
  }

  std::string writeParameters() const {
    std::string text = "parameters:\n" + writeGravityParameter();
    if (text == "parameters:\n" && import_.parameters.getAll().empty()) {
      throw ExperimentError(import_.robot.file +
                            ": has no gravity, and nothing else to estimate: give --parameters");
    }
    for (const RobotParameter& one : import_.parameters.getAll()) {
      text +=
          fmt::format("  {}: {{bounds: [{}, {}], ", one.name, writeNumber(one.lower), writeNumber(one.upper));
      text += one.has_prior ? fmt::format("prior: {{normal: {{mean: {}, stddev: {}}}}}, ",
                                          writeNumber(one.value), writeNumber(one.stddev))
                            : "";
      text += "unit: " + one.unit + "}\n";
    }
    return text;
  }

  bool isBody(const Link& link) const {
    return std::any_of(import_.assembly.bodies.begin(), import_.assembly.bodies.end(),
                       [&](const Body& body) { return body.link == &link; });
  }

  /// Links that are not bodies.
  void noteFrames() {
    for (const Link& link : import_.robot.links) {
      if (link.inertial && !link.hasMass()) {
        const Matrix& t = link.inertial->tensor;
        const bool has_tensor = !isZero(t.x) || !isZero(t.y) || !isZero(t.z);
        if (has_tensor) {
          import_.robot.leaveOut(link.inertial->line, "<inertia> of a link without mass",
                                 "no body has it: give the link a mass");
        }
      }
      if (!link.hasMass() && !import_.robot.gravity && !isBody(link)) {
        import_.robot.leaveOut(link.line, "<link> without mass",
                               "a frame of the link that it is fixed to: no body");
      }
    }
  }

  std::string writeTail() {
    std::string outputs, columns, noise;
    std::vector<std::string> all, recorded;
    for (const auto& [name, quantity] : listOutputs()) {
      outputs += fmt::format("  {}: {{{}}}\n", name, quantity);
      noise += (noise.empty() ? "" : ", ") + name + ": unknown";
      all.push_back(name);
      if (const std::string* column = import_.recording ? import_.recording->take(name) : nullptr) {
        columns += (columns.empty() ? "" : ", ") + name + ": " + quote(*column);
        recorded.push_back(name);
      }
    }
    if (all.empty()) {
      throw ExperimentError(import_.robot.file + ": has no joint that moves: try --base free");
    }
    return (acting_.getSignals().empty() ? "" : "excitation:\n" + acting_.getSignals()) + "outputs:\n" +
           outputs + writeSamples(import_.recording ? recorded : all) + "noise: {stddev: {" + noise + "}}\n" +
           writeMeasurement(columns);
  }

  /// A motion is prescribed of a joint with one coordinate.
  void requireSingle(const Body& body) const {
    if (body.joint == nullptr || !body.joint->isSingle()) {
      failAt(
          import_.robot.file, body.joint != nullptr ? body.joint->line : body.link->line,
          "link '" + body.link->name +
              "' flies, turns as a ball or moves in a plane: --from-motion knows joints that turn or slide "
              "alone. Simulate the motion from the forces: leave --from-motion out");
    }
  }

  /// Names, and what is measured: how the robot moves, or what its drives exert.
  std::vector<std::pair<std::string, std::string>> listOutputs() {
    std::vector<std::pair<std::string, std::string>> outputs;
    for (const Drive& drive : acting_.getDrives()) {
      outputs.emplace_back(drive.output, "force_of: " + drive.coordinate);
    }
    for (const Body& body : import_.assembly.bodies) {
      for (const std::string& q : import_.names.takeCoordinates(body)) {
        if (import_.options.from_motion) {
          requireSingle(body);
        } else {
          outputs.emplace_back(q, "coordinate: " + q);
        }
      }
    }
    return outputs;
  }

  std::string writeSamples(const std::vector<std::string>& outputs) const {
    if (outputs.empty()) {
      throw ExperimentError(import_.recording->file + ": no column is called as a joint of " +
                            import_.robot.file);
    }
    const double interval = import_.recording ? import_.recording->interval : kInterval;
    const int count = import_.recording ? import_.recording->count : kCount;
    return fmt::format(
        "simulation: {{duration: {}}}\nfeatures:\n  - samples: {{outputs: [{}], start: 0, interval: {}, "
        "count: {}}}\n",
        toShortText(interval * (count - 1), 12), fmt::join(outputs, ", "), toShortText(interval, 12), count);
  }

  std::string writeMeasurement(const std::string& columns) {
    if (!import_.recording) {
      return "";
    }
    for (const std::string& unused : import_.recording->listUnused()) {
      import_.robot.leaveOut(
          0, "column '" + unused + "' of " + import_.recording->file,
          "it is called as no coordinate, and as no signal: say in 'measurement' or 'excitation' what it is");
    }
    return fmt::format("measurement:\n  time: {}\n  start: {}\n  columns: {{{}}}\n",
                       quote(import_.recording->time), writeNumber(import_.recording->first), columns);
  }

  static constexpr double kInterval = 0.01;  ///< s
  static constexpr int kCount = 101;
  static constexpr double kGravity = 9.81;       ///< m/s2
  static constexpr double kGravityReach = 0.03;  ///< m/s2; at sea level it is 9.780 to 9.832 (WGS 84)

  RobotImport import_;
  ActingWriter acting_;
};

}  // namespace

std::string makeExperimentText(Robot& robot, const ImportOptions& options) {
  return ExperimentWriter(robot, options).write();
}

std::vector<std::string> describeLeftOut(const Robot& robot) {
  std::vector<std::string> texts;
  for (const LeftOut& one : robot.left_out) {
    std::string lines;
    for (const int line : one.lines) {
      lines += (lines.empty() ? "" : ", ") + (line > 0 ? std::to_string(line) : "-");
    }
    texts.push_back(robot.file + ":" + lines + ": " + one.what + ": " + one.effect);
  }
  return texts;
}

}  // namespace twinmap::robots
