#include "framework/robots/shape_text.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

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

namespace fs = std::filesystem;

constexpr const char *kFile = "file://", *kPackage = "package://";

/// Folders that packages of ROS may stand in: those of ROS_PACKAGE_PATH, those above the robot's file.
std::vector<fs::path> listPackageFolders(const std::string& robot_file) {
  std::vector<fs::path> folders;
  const char* listed = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream words(listed != nullptr ? listed : "");
  for (std::string folder; std::getline(words, folder, ':') && !folder.empty();) {
    folders.insert(folders.end(), {folder, fs::path(folder).parent_path()});  // it may be a package itself
  }
  fs::path above = fs::absolute(robot_file).lexically_normal();
  while (above.has_relative_path()) {
    above = above.parent_path();
    folders.push_back(above);
  }
  return folders;
}

}  // namespace

std::string locateMesh(const std::string& robot_file, const std::string& mesh) {
  if (mesh.rfind(kFile, 0) == 0) {
    return mesh.substr(std::string(kFile).size());
  }
  if (mesh.rfind(kPackage, 0) == 0) {
    for (const fs::path& folder : listPackageFolders(robot_file)) {
      const fs::path place = folder / mesh.substr(std::string(kPackage).size());
      std::error_code failure;
      if (fs::is_regular_file(place, failure)) {
        return place.string();
      }
    }
  }
  const bool is_elsewhere = mesh.find("://") != std::string::npos;
  return is_elsewhere ? mesh : (fs::path(robot_file).parent_path() / mesh).string();
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
