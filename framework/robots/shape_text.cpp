#include "framework/robots/shape_text.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "framework/robots/recording.hpp"
#include "framework/robots/yaml_text.hpp"

namespace twinmap::robots {
namespace {

std::string writeRound(const char* kind, const RoundShapeSpec& round) {
  return fmt::format("{}: {{radius: {}, length: {}}}", kind, writeNumber(round.radius),
                     writeNumber(round.length));
}

std::string writeTriple(const std::array<double, 3>& numbers) {
  return writeVector({numbers[0], numbers[1], numbers[2]});
}

std::string writeShape(const ShapeSpec& shape) {
  if (shape.box) {
    return "box: " + writeTriple(*shape.box);
  }
  if (shape.sphere) {
    return "sphere: " + writeNumber(*shape.sphere);
  }
  if (shape.mesh) {
    const bool is_scaled = shape.scale != ShapeSpec{}.scale;
    return "mesh: " + quote(shape.mesh->text) + (is_scaled ? ", scale: " + writeTriple(shape.scale) : "");
  }
  return shape.cylinder ? writeRound("cylinder", *shape.cylinder) : writeRound("capsule", *shape.capsule);
}

}  // namespace

std::string locateMesh(const std::string& robot_file, const std::string& mesh) {
  constexpr const char* kFile = "file://";
  if (mesh.rfind(kFile, 0) == 0) {
    return mesh.substr(std::string(kFile).size());
  }
  const bool is_elsewhere = mesh.find("://") != std::string::npos;
  return is_elsewhere ? mesh : (std::filesystem::path(robot_file).parent_path() / mesh).string();
}

void noteGround(Robot& robot, const Assembly& assembly) {
  for (const Link& link : robot.links) {
    for (const Visual& visual : link.visuals) {
      if (assembly.places.at(link.name).body == nullptr) {
        robot.leaveOut(visual.line, "<visual> of the ground", "a drawing; it moves nothing");
      }
    }
  }
}

std::string writeShapes(const Robot& robot, const Assembly& assembly, const Link& body) {
  std::string text;
  for (const Link& link : robot.links) {
    const Place& place = assembly.places.at(link.name);
    for (std::size_t i = 0; i < link.visuals.size() && place.body == &body; ++i) {
      const Visual& visual = link.visuals[i];
      const std::string pose = writePose(place.frame * visual.frame);
      text += fmt::format("        - {{{}{}{}}}\n", writeShape(visual.shape), pose.empty() ? "" : ", ", pose);
    }
  }
  return text.empty() ? "" : "      shapes:\n" + text;
}

}  // namespace twinmap::robots
