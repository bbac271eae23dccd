#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {

SimTK::Transform toTransform(const FrameNumbers& frame) {
  SimTK::Rotation rotation;
  rotation.setRotationToBodyFixedXYZ(toVec3(frame.angles));
  return SimTK::Transform(rotation, toVec3(frame.point));
}

SimTK::MassProperties toMassProperties(const MassNumbers& numbers) {
  SimTK::Inertia about_origin(toVec3(numbers.moments), toVec3(numbers.products));
  about_origin.shiftFromMassCenterInPlace(toVec3(numbers.center), numbers.mass);
  return SimTK::MassProperties(numbers.mass, toVec3(numbers.center), about_origin);
}

}  // namespace twinmap
