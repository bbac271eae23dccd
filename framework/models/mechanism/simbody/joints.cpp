#include "framework/models/mechanism/simbody/joints.hpp"

#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::Transform;
using SimTK::Vec3;

/// The rotation that carries the axis Simbody's mobilizer uses onto the joint's axis.
Rotation calcAxisAlignment(JointType type, const std::optional<Eigen::Vector3d>& axis) {
  if (!axis) {
    return Rotation();
  }
  const SimTK::CoordinateAxis own = getTraits(type).axis == JointAxis::kX
                                        ? static_cast<SimTK::CoordinateAxis>(SimTK::XAxis)
                                        : static_cast<SimTK::CoordinateAxis>(SimTK::ZAxis);
  return Rotation(SimTK::UnitVec3(toVec3(*axis)), own);
}

struct Joint {
  MobilizedBody parent;
  const SimTK::Body& body;
  Transform in_parent, in_body;

  template <typename Mobilizer, typename... Numbers>
  void add(Numbers... more) {
    Mobilizer(parent, in_parent, body, in_body, more...);
  }
};

}  // namespace

void addMobilizer(MobilizedBody parent, const SimTK::Body& body, const BodySpec& spec,
                  ModelNumbers& numbers) {
  const JointNumbers values = calcJointNumbers(spec, numbers);
  const Transform alignment(calcAxisAlignment(spec.joint.type, values.axis));
  Joint joint{parent, body, toTransform(values.in_parent) * alignment,
              toTransform(values.in_body) * alignment};
  switch (spec.joint.type) {
    case JointType::kWeld:
      return joint.add<MobilizedBody::Weld>();
    case JointType::kSlider:
      return joint.add<MobilizedBody::Slider>();
    case JointType::kPin:
      return joint.add<MobilizedBody::Pin>();
    case JointType::kCylinder:
      return joint.add<MobilizedBody::Cylinder>();
    case JointType::kUniversal:
      return joint.add<MobilizedBody::Universal>();
    case JointType::kBendStretch:
      return joint.add<MobilizedBody::BendStretch>();
    case JointType::kPlanar:
      return joint.add<MobilizedBody::Planar>();
    case JointType::kTranslation:
      return joint.add<MobilizedBody::Translation>();
    case JointType::kGimbal:
      return joint.add<MobilizedBody::Gimbal>();
    case JointType::kBall:
      return joint.add<MobilizedBody::Ball>();
    case JointType::kBushing:
      return joint.add<MobilizedBody::Bushing>();
    case JointType::kFree:
      return joint.add<MobilizedBody::Free>();
    case JointType::kScrew:
      return joint.add<MobilizedBody::Screw>(values.pitch);
  }
}

}  // namespace twinmap
