#include "framework/spec/joint_type.hpp"

namespace twinmap {

const std::vector<CoordinateKind>& getCoordinateKinds(JointType type) {
  using Kinds = std::vector<CoordinateKind>;
  constexpr CoordinateKind kR = CoordinateKind::kRotation;
  constexpr CoordinateKind kT = CoordinateKind::kTranslation;
  static const Kinds kNone{}, kOneR{kR}, kOneT{kT}, kRT{kR, kT}, kRR{kR, kR}, kRTT{kR, kT, kT};
  static const Kinds kThreeT{kT, kT, kT}, kThreeR{kR, kR, kR}, kSix{kR, kR, kR, kT, kT, kT};
  switch (type) {
    case JointType::kWeld:
      return kNone;
    case JointType::kSlider:
      return kOneT;
    case JointType::kPin:
    case JointType::kScrew:
      return kOneR;
    case JointType::kCylinder:
    case JointType::kBendStretch:
      return kRT;
    case JointType::kUniversal:
      return kRR;
    case JointType::kPlanar:
      return kRTT;
    case JointType::kTranslation:
      return kThreeT;
    case JointType::kGimbal:
    case JointType::kBall:
      return kThreeR;
    case JointType::kBushing:
    case JointType::kFree:
      return kSix;
  }
  return kNone;
}

int getCoordinateCount(JointType type) { return static_cast<int>(getCoordinateKinds(type).size()); }

bool hasAxis(JointType type) {
  return type == JointType::kSlider || type == JointType::kPin || type == JointType::kScrew ||
         type == JointType::kCylinder;
}

const char* getUnit(CoordinateKind kind) { return kind == CoordinateKind::kRotation ? "rad" : "m"; }

}  // namespace twinmap
