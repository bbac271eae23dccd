#include "framework/experiment/model/joint_type.hpp"

#include <stdexcept>

namespace twinmap {
namespace {

constexpr JointCoordinate kLength{CoordinateKind::kTranslation, true};
constexpr JointCoordinate kAngle{CoordinateKind::kRotation, true};
constexpr JointCoordinate kAngleWithoutForce{CoordinateKind::kRotation, false};

}  // namespace

const std::vector<JointCoordinate>& getJointCoordinates(JointType type) {
  using Coordinates = std::vector<JointCoordinate>;
  static const Coordinates none;
  static const Coordinates length{kLength};
  static const Coordinates angle{kAngle};
  static const Coordinates two_angles{kAngle, kAngle};
  static const Coordinates angle_and_length{kAngle, kLength};
  static const Coordinates angle_and_two_lengths{kAngle, kLength, kLength};
  static const Coordinates three_lengths{kLength, kLength, kLength};
  static const Coordinates three_angles{kAngle, kAngle, kAngle};
  static const Coordinates ball{kAngleWithoutForce, kAngleWithoutForce, kAngleWithoutForce};
  static const Coordinates bushing{kAngle, kAngle, kAngle, kLength, kLength, kLength};
  static const Coordinates free{
      kAngleWithoutForce, kAngleWithoutForce, kAngleWithoutForce, kLength, kLength, kLength};
  switch (type) {
    case JointType::kWeld:
      return none;
    case JointType::kSlider:
      return length;
    case JointType::kPin:
    case JointType::kScrew:
      return angle;
    case JointType::kUniversal:
      return two_angles;
    case JointType::kCylinder:
    case JointType::kBendStretch:
      return angle_and_length;
    case JointType::kPlanar:
      return angle_and_two_lengths;
    case JointType::kTranslation:
      return three_lengths;
    case JointType::kGimbal:
      return three_angles;
    case JointType::kBall:
      return ball;
    case JointType::kBushing:
      return bushing;
    case JointType::kFree:
      return free;
  }
  throw std::logic_error("unknown joint type");
}

int getCoordinateCount(JointType type) {
  return static_cast<int>(getJointCoordinates(type).size());
}

bool hasAxis(JointType type) {
  return type == JointType::kSlider || type == JointType::kPin || type == JointType::kScrew ||
         type == JointType::kCylinder;
}

const char* getUnit(CoordinateKind kind) {
  return kind == CoordinateKind::kTranslation ? "m" : "rad";
}

const char* getSpeedUnit(CoordinateKind kind) {
  return kind == CoordinateKind::kTranslation ? "m/s" : "rad/s";
}

}  // namespace twinmap
