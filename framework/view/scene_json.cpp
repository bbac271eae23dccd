#include "framework/view/scene_json.hpp"

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap::view {
namespace {

Json toJson(const Vector& v) {
  return {v.x, v.y, v.z};
}

/// Columns of the rotation, then the origin.
Json toJson(const Pose& pose) {
  const auto& r = pose.rotation;
  return {r.x.x, r.x.y, r.x.z, r.y.x,         r.y.y,         r.y.z,
          r.z.x, r.z.y, r.z.z, pose.origin.x, pose.origin.y, pose.origin.z};
}

void append(const Json& numbers, std::string& text) {
  constexpr int kDigits = 8;
  for (const Json& number : numbers) {
    text += (text.back() == '[' ? "" : ",") + toShortText(number.get<double>(), kDigits);
  }
}

/// Of each motion one list of numbers: frames, bodies, twelve each; millions of values of JSON would take
/// longer to make than to simulate.
std::string makeMotionJson(const SceneMotion& motion) {
  std::string text = "{\"name\":" + formatJson(Json(motion.name)) + ",\"poses\":[";
  for (const std::vector<Pose>& frame : motion.poses) {
    for (const Pose& pose : frame) {
      append(toJson(pose), text);
    }
  }
  text += "],\"outputs\":[";
  for (const auto& row : motion.outputs.rowwise()) {
    text += text.back() == '[' ? "[" : ",[";
    append(Json(std::vector<double>(row.begin(), row.end())), text);
    text += "]";
  }
  return text + "]}";
}

Json describeBodies(const Scene& scene) {
  Json bodies = Json::array();
  for (const SceneBody& body : scene.bodies) {
    bodies.push_back({{"name", body.name},
                      {"parent", body.parent},
                      {"mass", body.has_mass},
                      {"ellipsoid", toJson(body.ellipsoid.frame)},
                      {"radii", toJson(body.ellipsoid.radii)},
                      {"joint", body.joint},
                      {"in_parent", toJson(body.in_parent)},
                      {"axis", toJson(body.axis)}});
  }
  return bodies;
}

}  // namespace

std::string makeSceneJson(const Scene& scene) {
  Json json{{"name", scene.name}, {"gravity", toJson(scene.gravity)}, {"bodies", describeBodies(scene)}};
  json["times"] = std::vector<double>(scene.times.begin(), scene.times.end());
  json["lines"] = Json::array();
  for (const SceneLine& line : scene.lines) {
    json["lines"].push_back({{"kind", line.kind},
                             {"from", line.from},
                             {"to", line.to},
                             {"from_point", toJson(line.from_point)},
                             {"to_point", toJson(line.to_point)}});
  }
  json["marks"] = Json::array();
  for (const SceneMark& mark : scene.marks) {
    json["marks"].push_back({{"kind", mark.kind},
                             {"name", mark.name},
                             {"body", mark.body},
                             {"point", toJson(mark.point)},
                             {"direction", toJson(mark.direction)}});
  }
  json["outputs"] = Json::array();
  for (const SceneOutput& output : scene.outputs) {
    json["outputs"].push_back({{"name", output.name}, {"unit", output.unit}});
  }
  std::string text = formatJson(json);
  text.back() = ',';
  text += "\"motions\":[";
  for (const SceneMotion& motion : scene.motions) {
    text += (text.back() == '[' ? "" : ",") + makeMotionJson(motion);
  }
  return text + "]}";
}

}  // namespace twinmap::view
