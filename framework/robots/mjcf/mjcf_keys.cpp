#include "framework/robots/mjcf/mjcf_keys.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace twinmap::robots {
namespace {

constexpr std::pair<const char*, const char*> kLeftOut[] = {
    {"geom", "contact with other bodies (its shape and mass count): describe what touches in 'contacts'"},
    {"site", "a place for sensors and tendons: describe them in 'outputs'"},
    {"camera", "a view; it moves nothing"},
    {"light", "a view; it moves nothing"},
    {"asset", "meshes, textures, materials (masses of meshes count)"},
    {"visual", "a drawing; it moves nothing"},
    {"statistic", "a drawing; it moves nothing"},
    {"size", "memory of MuJoCo"},
    {"custom", "data of other programs"},
    {"contact", "which bodies touch: describe what touches in 'contacts'"},
    {"tendon", "forces along a path: describe them in 'two_point_springs' or 'force_laws'"},
    {"sensor", "sensors: describe them in 'outputs'"},
    {"keyframe", "states: describe one in 'initial'"},
    {"extension", "plugins: what they do is not known"},
    {"plugin", "a plugin: what it does is not known"},
    {"deformable", "soft bodies"},
    {"flexcomp", "soft bodies"},
    {"composite", "many bodies at once, soft ones too"},
    {"include", "what the file has is carried over; what of it is left out is not listed here"},
    {"replicate", "copies are carried over; what of them is left out is listed once"},
};

}  // namespace

const char* findMjcfEffect(const std::string& element) {
  const auto* const found = std::find_if(std::begin(kLeftOut), std::end(kLeftOut),
                                         [&](const auto& one) { return element == one.first; });
  return found == std::end(kLeftOut) ? nullptr : found->second;
}

}  // namespace twinmap::robots
