#include "framework/robots/urdf/urdf_keys.hpp"

#include <algorithm>
#include <iterator>

namespace twinmap::robots {
namespace {

constexpr const char* kCarried = nullptr;

constexpr UrdfKey kKeys[] = {
    {"robot", kCarried},
    {"robot@name", kCarried},
    {"robot@version", kCarried},
    {"robot/link", kCarried},
    {"robot/link@name", kCarried},
    {"robot/link@type", "kind of link for some programs; it moves nothing"},
    {"robot/link/inertial", kCarried},
    {"robot/link/inertial/origin", kCarried},
    {"robot/link/inertial/origin@xyz", kCarried},
    {"robot/link/inertial/origin@rpy", kCarried},
    {"robot/link/inertial/mass", kCarried},
    {"robot/link/inertial/mass@value", kCarried},
    {"robot/link/inertial/inertia", kCarried},
    {"robot/link/inertial/inertia@ixx", kCarried},
    {"robot/link/inertial/inertia@ixy", kCarried},
    {"robot/link/inertial/inertia@ixz", kCarried},
    {"robot/link/inertial/inertia@iyy", kCarried},
    {"robot/link/inertial/inertia@iyz", kCarried},
    {"robot/link/inertial/inertia@izz", kCarried},
    {"robot/link/visual", kCarried},
    {"robot/link/visual@name", "the name of a drawing"},
    {"robot/link/visual/origin", kCarried},
    {"robot/link/visual/origin@xyz", kCarried},
    {"robot/link/visual/origin@rpy", kCarried},
    {"robot/link/visual/geometry", kCarried},
    {"robot/link/visual/geometry/box", kCarried},
    {"robot/link/visual/geometry/box@size", kCarried},
    {"robot/link/visual/geometry/cylinder", kCarried},
    {"robot/link/visual/geometry/cylinder@radius", kCarried},
    {"robot/link/visual/geometry/cylinder@length", kCarried},
    {"robot/link/visual/geometry/capsule", kCarried},
    {"robot/link/visual/geometry/capsule@radius", kCarried},
    {"robot/link/visual/geometry/capsule@length", kCarried},
    {"robot/link/visual/geometry/sphere", kCarried},
    {"robot/link/visual/geometry/sphere@radius", kCarried},
    {"robot/link/visual/geometry/mesh", kCarried},
    {"robot/link/visual/geometry/mesh@filename", kCarried},
    {"robot/link/visual/geometry/mesh@scale", kCarried},
    {"robot/link/visual/material", "a colour; it moves nothing"},
    {"robot/link/collision", "contact with other bodies: describe what touches in 'contacts'"},
    {"robot/link/self_collision_checking", "contact with other bodies: describe what touches in 'contacts'"},
    {"robot/link/contact", "friction and stiffness of contacts: describe what touches in 'contacts'"},
    {"robot/joint", kCarried},
    {"robot/joint@name", kCarried},
    {"robot/joint@type", kCarried},
    {"robot/joint/origin", kCarried},
    {"robot/joint/origin@xyz", kCarried},
    {"robot/joint/origin@rpy", kCarried},
    {"robot/joint/parent", kCarried},
    {"robot/joint/parent@link", kCarried},
    {"robot/joint/child", kCarried},
    {"robot/joint/child@link", kCarried},
    {"robot/joint/axis", kCarried},
    {"robot/joint/axis@xyz", kCarried},
    {"robot/joint/dynamics", kCarried},
    {"robot/joint/dynamics@damping", kCarried},
    {"robot/joint/dynamics@friction", kCarried},
    {"robot/joint/limit", kCarried},
    {"robot/joint/limit@lower", kCarried},
    {"robot/joint/limit@upper", kCarried},
    {"robot/joint/limit@effort", "the drive's largest force: signals of the model are not limited"},
    {"robot/joint/limit@velocity", "the drive's largest speed: nothing holds the model to it"},
    {"robot/joint/mimic", kCarried},
    {"robot/joint/mimic@joint", kCarried},
    {"robot/joint/mimic@multiplier", kCarried},
    {"robot/joint/mimic@offset", kCarried},
    {"robot/joint/calibration", "where an encoder has its marks; it moves nothing"},
    {"robot/joint/safety_controller", "limits that a controller keeps: describe it in 'controllers'"},
    {"robot/transmission", "between motors and joints: forces of the model act on the joints"},
    {"robot/material", "a colour; it moves nothing"},
    {"robot/gazebo", "settings of Gazebo"},
    {"robot/mujoco", "settings of MuJoCo"},
    {"robot/sensor", "a sensor: describe it in 'outputs'"},
    {"robot/ros2_control", "interfaces of controllers: describe them in 'controllers'"},
};

}  // namespace

const UrdfKey* findUrdfKey(const std::string& path) {
  const auto* const found =
      std::find_if(std::begin(kKeys), std::end(kKeys), [&](const UrdfKey& key) { return path == key.path; });
  return found == std::end(kKeys) ? nullptr : found;
}

}  // namespace twinmap::robots
