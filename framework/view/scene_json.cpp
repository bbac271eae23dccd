#include "framework/view/scene_json.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/base/text/base64.hpp"
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

/// A unit quaternion (x, y, z, w) of a rotation, by its largest entry (Shepperd 1978).
std::array<double, 4> calcQuaternion(const algebra::Mat33<double>& r) {
  const double trace = r.x.x + r.y.y + r.z.z;
  const std::array<double, 4> squares{1.0 + 2.0 * r.x.x - trace, 1.0 + 2.0 * r.y.y - trace,
                                      1.0 + 2.0 * r.z.z - trace, 1.0 + trace};  // four times
  const double xy = r.x.y + r.y.x, xz = r.x.z + r.z.x,
               yz = r.y.z + r.z.y;  // columns: r.x.y is row 2, column 1
  const double wx = r.y.z - r.z.y, wy = r.z.x - r.x.z, wz = r.x.y - r.y.x;
  const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  const double root = std::sqrt(squares[static_cast<std::size_t>(largest)]), by = 0.5 / root;
  switch (largest) {
    case 0:
      return {0.5 * root, by * xy, by * xz, by * wx};
    case 1:
      return {by * xy, 0.5 * root, by * yz, by * wy};
    case 2:
      return {by * xz, by * yz, 0.5 * root, by * wz};
    default:
      return {by * wx, by * wy, by * wz, 0.5 * root};
  }
}

/// Seven floats a pose, quaternion and origin, in base64: 60 bodies and three motions stay below 3 MB.
std::string makePosesJson(const std::vector<std::vector<Pose>>& frames) {
  std::vector<unsigned char> bytes;
  for (const std::vector<Pose>& frame : frames) {
    for (const Pose& pose : frame) {
      const auto q = calcQuaternion(pose.rotation);
      const Vector& o = pose.origin;
      for (const double number : {q[0], q[1], q[2], q[3], o.x, o.y, o.z}) {
        const auto rounded = static_cast<float>(number);
        const auto* const first = reinterpret_cast<const unsigned char*>(&rounded);
        bytes.insert(bytes.end(), first, first + sizeof rounded);
      }
    }
  }
  return "\"" + encodeBase64(bytes) + "\"";
}

/// Without Json for the outputs: millions of its values would take longer to make than to simulate.
std::string makeMotionJson(const SceneMotion& motion) {
  std::string text = "{\"name\":" + formatJson(Json(motion.name)) +
                     ",\"poses\":" + makePosesJson(motion.poses) + ",\"outputs\":[";
  for (const auto& row : motion.outputs.rowwise()) {
    text += text.back() == '[' ? "[" : ",[";
    append(Json(std::vector<double>(row.begin(), row.end())), text);
    text += "]";
  }
  return text + "]}";
}

template <class Number>
std::string encode(const std::vector<std::array<Number, 3>>& triples) {
  const auto* const first = reinterpret_cast<const unsigned char*>(triples.data());
  return encodeBase64({first, first + triples.size() * sizeof(triples[0])});
}

Json describeShapes(const SceneBody& body) {
  Json shapes = Json::array();
  for (const SceneShape& shape : body.shapes) {
    shapes.push_back({{"kind", shape.kind}, {"frame", toJson(shape.frame)}, {"size", toJson(shape.size)}});
    if (!shape.mesh.triangles.empty()) {
      shapes.back()["points"] = encode(shape.mesh.points);
      shapes.back()["triangles"] = encode(shape.mesh.triangles);
    }
  }
  return shapes;
}

/// NaN is null.
Json describeOutput(const SceneOutput& output) {
  Json json{{"name", output.name}, {"unit", output.unit}, {"body", output.body}};
  if (output.measured) {
    const SceneMeasured& measured = *output.measured;
    json["measured"] = {{"times", measured.times},
                        {"values", measured.values},
                        {"residual", measured.residual},
                        {"scale", measured.scale}};
  }
  return json;
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
                      {"axis", toJson(body.axis)},
                      {"acting", body.acting},
                      {"shapes", describeShapes(body)}});
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
  json["remarks"] = scene.remarks;
  json["outputs"] = Json::array();
  for (const SceneOutput& output : scene.outputs) {
    json["outputs"].push_back(describeOutput(output));
  }
  std::string text = formatJson(json);
  text.back() = ',';
  text += "\"motions\":[";
  for (const SceneMotion& motion : scene.motions) {
    text += (text.back() == '[' ? "" : ",") + makeMotionJson(motion);
  }
  text += "],\"modes\":[";
  for (const SceneMode& mode : scene.modes) {
    text += (text.back() == '[' ? "{\"frequency\":" : ",{\"frequency\":") + toText(mode.frequency) +
            ",\"damping\":" + toText(mode.damping_ratio) + ",\"poses\":" + makePosesJson(mode.poses) + "}";
  }
  return text + "]}";
}

}  // namespace twinmap::view
