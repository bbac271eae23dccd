#include "framework/models/mechanism/simbody/joints.hpp"

#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::Transform;
using SimTK::Vec3;

/// The rotation that carries the axis Simbody's mobilizer uses onto the joint's axis.
Rotation calcAxisAlignment(const JointSpec& joint, NumberEvaluator& numbers, const std::string& owner) {
  if (!joint.axis) {
    return Rotation();
  }
  const Vec3 axis = calcVec3(numbers, *joint.axis, {owner, "joint.axis", ""});
  if (axis.norm() == 0.0) {
    throw SimulationFailure(owner + ": joint.axis must not be zero", (*joint.axis)[0].where);
  }
  const SimTK::CoordinateAxis own = joint.type == JointType::kSlider
                                        ? static_cast<SimTK::CoordinateAxis>(SimTK::XAxis)
                                        : static_cast<SimTK::CoordinateAxis>(SimTK::ZAxis);
  return Rotation(SimTK::UnitVec3(axis), own);
}

struct Joint {
  MobilizedBody parent;
  const JointNumbers& numbers;
  const SimTK::Body& body;

  template <typename Mobilizer, typename... Numbers>
  void add(Numbers... more) {
    Mobilizer(parent, numbers.in_parent, body, numbers.in_body, more...);
  }
};

}  // namespace

Transform calcFrame(const FrameSpec& frame, NumberEvaluator& numbers, const std::string& owner) {
  const Vec3 angles = calcVec3(numbers, frame.orientation, {owner, "orientation", "rad"});
  Rotation rotation;
  rotation.setRotationToBodyFixedXYZ(angles);
  return Transform(rotation, calcVec3(numbers, frame.point, {owner, "point", "m"}));
}

JointNumbers calcJointNumbers(const BodySpec& spec, NumberEvaluator& numbers) {
  const std::string owner = "body '" + spec.name.text + "'";
  const Transform alignment(calcAxisAlignment(spec.joint, numbers, owner));
  JointNumbers joint{calcFrame(spec.joint.in_parent, numbers, owner) * alignment,
                     calcFrame(spec.joint.in_body, numbers, owner) * alignment, 0.0};
  if (spec.joint.type == JointType::kScrew) {
    joint.pitch = numbers.calc(spec.joint.pitch, {owner, "joint.pitch", "m/rad"});
  }
  return joint;
}

void addMobilizer(MobilizedBody parent, const SimTK::Body& body, const BodySpec& spec,
                  NumberEvaluator& numbers) {
  const JointNumbers values = calcJointNumbers(spec, numbers);
  Joint joint{parent, values, body};
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
