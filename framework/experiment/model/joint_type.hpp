#pragma once

#include <array>

#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

enum class CoordinateKind { kTranslation, kRotation };

/// One coordinate of a joint. `takes_forces`: its speed is its time derivative, so that springs, dampers and
/// force laws may act on it directly. The three angles of ball and free joints do not: their speeds are the
/// components of the angular velocity; use a bushing, an applied moment, or a gimbal or bushing joint.
struct JointCoordinate {
  CoordinateKind kind{};
  bool takes_forces = false;
};

inline constexpr JointCoordinate kLength{CoordinateKind::kTranslation, true};
inline constexpr JointCoordinate kAngle{CoordinateKind::kRotation, true};
inline constexpr JointCoordinate kSpunAngle{CoordinateKind::kRotation, false};

/// The coordinates of a joint in their order; at most six.
class JointCoordinates {
 public:
  template <class... Coordinate>
  constexpr JointCoordinates(Coordinate... coordinate)
      : items_{coordinate...}, count_(sizeof...(coordinate)) {}

  constexpr std::size_t size() const { return count_; }
  constexpr const JointCoordinate& operator[](std::size_t i) const { return items_[i]; }

 private:
  std::array<JointCoordinate, 6> items_;
  std::size_t count_;
};

/// Mobilities between a body and its parent. Coordinates in the order and units given in
/// docs/reference/experiment-file.md; angles in rad, lengths in m.
enum class JointType {
  kWeld,
  kSlider,
  kPin,
  kScrew,
  kCylinder,
  kUniversal,
  kBendStretch,
  kPlanar,
  kTranslation,
  kGimbal,
  kBall,
  kBushing,
  kFree,
};

/// Whether a joint takes an `axis`, and its default.
enum class JointAxis { kNone, kX, kZ };

/// What the file, its checks and the equations must know of a joint besides its motion.
struct JointTraits : EnumName<JointType> {
  JointCoordinates coordinates;
  JointAxis axis = JointAxis::kNone;
  bool has_pitch = false;  ///< translates by `pitch` m/rad
};

/// In the order of JointType.
inline constexpr JointTraits kJoints[] = {
    {{"weld", JointType::kWeld}, {}},
    // translation along `axis`; rotation about it, rotation that also translates, rotation and translation
    {{"slider", JointType::kSlider}, {kLength}, JointAxis::kX},
    {{"pin", JointType::kPin}, {kAngle}, JointAxis::kZ},
    {{"screw", JointType::kScrew}, {kAngle}, JointAxis::kZ, true},
    {{"cylinder", JointType::kCylinder}, {kAngle, kLength}, JointAxis::kZ},
    // rotations about x, then y
    {{"universal", JointType::kUniversal}, {kAngle, kAngle}},
    // rotation about z, then translation along the rotated x
    {{"bend_stretch", JointType::kBendStretch}, {kAngle, kLength}},
    // rotation about z, translations along x and y
    {{"planar", JointType::kPlanar}, {kAngle, kLength, kLength}},
    {{"translation", JointType::kTranslation}, {kLength, kLength, kLength}},
    // body-fixed x-y-z angles, then translations; the speeds of ball and free are the angular velocity
    {{"gimbal", JointType::kGimbal}, {kAngle, kAngle, kAngle}},
    {{"ball", JointType::kBall}, {kSpunAngle, kSpunAngle, kSpunAngle}},
    {{"bushing", JointType::kBushing}, {kAngle, kAngle, kAngle, kLength, kLength, kLength}},
    {{"free", JointType::kFree}, {kSpunAngle, kSpunAngle, kSpunAngle, kLength, kLength, kLength}},
};

template <>
struct EnumNames<JointType> {
  static constexpr const auto& values = kJoints;
};

constexpr const JointTraits& getTraits(JointType type) {
  return kJoints[static_cast<std::size_t>(type)];
}

constexpr bool areInOrder() {
  std::size_t i = 0;
  for (const JointTraits& joint : kJoints) {
    if (static_cast<std::size_t>(joint.value) != i++) {
      return false;
    }
  }
  return true;
}
static_assert(areInOrder(), "kJoints must list the joints in the order of JointType");

constexpr const JointCoordinates& getJointCoordinates(JointType type) {
  return getTraits(type).coordinates;
}
constexpr int getCoordinateCount(JointType type) {
  return static_cast<int>(getJointCoordinates(type).size());
}
constexpr bool hasAxis(JointType type) {
  return getTraits(type).axis != JointAxis::kNone;
}
/// Whether the first three speeds are an angular velocity, in the parent's joint frame, not angle rates.
constexpr bool hasAngularVelocity(JointType type) {
  return getCoordinateCount(type) > 0 && !getJointCoordinates(type)[0].takes_forces;
}

/// "m" or "rad"; and of its time derivative, "m/s" or "rad/s".
constexpr const char* getUnit(CoordinateKind kind) {
  return kind == CoordinateKind::kTranslation ? "m" : "rad";
}
constexpr const char* getSpeedUnit(CoordinateKind kind) {
  return kind == CoordinateKind::kTranslation ? "m/s" : "rad/s";
}
/// Of a force on it: "N" or "N m".
constexpr const char* getForceUnit(CoordinateKind kind) {
  return kind == CoordinateKind::kTranslation ? "N" : "N m";
}

}  // namespace twinmap
