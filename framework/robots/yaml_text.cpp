#include "framework/robots/yaml_text.hpp"

#include <fmt/format.h>

#include "framework/base/text/number_text.hpp"
#include "framework/robots/inertia.hpp"

namespace twinmap::robots {

std::string writeNumber(double value) {
  std::string text = toText(value + 0.0);
  const std::size_t exponent = text.find('e');
  return exponent == std::string::npos || text.find('.') != std::string::npos ? text
                                                                              : text.insert(exponent, ".0");
}

std::string writeVector(const Vector& v) {
  return "[" + writeNumber(v.x) + ", " + writeNumber(v.y) + ", " + writeNumber(v.z) + "]";
}

bool isZero(const Vector& v) {
  return v.x == 0.0 && v.y == 0.0 && v.z == 0.0;
}

std::string writePose(const Pose& frame) {
  const Vector angles = calcAngles(frame.rotation);
  std::string text;
  if (!isZero(frame.origin)) {
    text += "point: " + writeVector(frame.origin);
  }
  if (!isZero(angles)) {
    text += (text.empty() ? "" : ", ") + ("orientation: " + writeVector(angles));
  }
  return text;
}

std::string writeFrame(const char* key, const Pose& frame) {
  const std::string pose = writePose(frame);
  return pose.empty() ? "" : fmt::format(", {}: {{{}}}", key, pose);
}

}  // namespace twinmap::robots
