#include "framework/robots/robot.hpp"

#include <algorithm>

#include "framework/base/text/source_location.hpp"

namespace twinmap::robots {

void Robot::leaveOut(int line, const std::string& what, const std::string& effect) {
  const auto same = std::find_if(left_out.begin(), left_out.end(), [&](const LeftOut& one) {
    return one.what == what && one.effect == effect;
  });
  if (same == left_out.end()) {
    left_out.push_back({{line}, what, effect});
  } else if (same->lines.back() != line) {
    same->lines.push_back(line);
  }
}

void failAt(const std::string& file, int line, const std::string& what) {
  throw ExperimentError(file + ":" + std::to_string(line) + ": " + what);
}

}  // namespace twinmap::robots
