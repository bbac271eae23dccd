#pragma once

#include <string>

#include "framework/robots/robot.hpp"

namespace twinmap::robots {

/// Mass, centre and tensor about the centre, all in the link's frame.
struct MassProperties {
  double mass = 0.0;
  Vector center;
  Matrix tensor;
};

MassProperties calcMassProperties(const Inertial& inertial);

/// "" or why no body has this tensor: a principal moment is negative, or larger than the other two together
/// (by more than what a mechanism's check allows for).
std::string describeImpossible(const Matrix& tensor);

/// How the mass is spread, as `inertia: {spread, skew}` of an experiment has it: the upper triangle S of
/// S S' = second moment of the mass about its centre / mass.
struct Spread {
  Vector spread, skew;  ///< m; x, y, z and xy, xz, yz
};

/// Spreads are not above 0 where the body is thin.
Spread calcSpread(const MassProperties& mass);

/// The tensor about the centre.
Matrix calcTensor(double mass, const Spread& spread);

/// Body-fixed x-y-z angles of a rotation, exact where they are not unique too.
Vector calcAngles(const Matrix& rotation);

}  // namespace twinmap::robots
