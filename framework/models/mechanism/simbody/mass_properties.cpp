#include "framework/models/mechanism/simbody/mass_properties.hpp"

#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using SimTK::Vec3;

/// A moment may break a rule by this much of the largest one: rounding of thin plates and rods.
constexpr double kInertiaSlack = 1e-9;

Eigen::Vector3d calcPrincipalMoments(const Vec3& moments, const Vec3& products) {
  Eigen::Matrix3d tensor;
  tensor << moments[0], products[0], products[1],  //
      products[0], moments[1], products[2],        //
      products[1], products[2], moments[2];
  return linalg::calcSymmetricEigenvalues(tensor);
}

void checkInertia(const std::string& owner, const Eigen::Vector3d& principal, const SourceLocation& where) {
  const double slack = kInertiaSlack * principal.cwiseAbs().maxCoeff();
  if (principal[0] < -slack) {
    throwUnusable({owner, "inertia: smallest principal moment", "kg m2"}, principal[0],
                  "must not be negative", where);
  }
  if (principal[2] > principal[0] + principal[1] + slack) {
    throwUnusable({owner, "inertia: largest principal moment", "kg m2"}, principal[2],
                  "must not exceed the sum of the other two", where);
  }
}

/// Simbody computes m c^2 and I / m, which must be numbers.
void checkRange(const BodySpec& body, const std::string& owner, double mass, const Vec3& center) {
  if (!std::isfinite(1.0 / mass)) {
    throwUnusable({owner, "mass", "kg"}, mass, "is too small: its inverse must be finite", body.mass.where);
  }
  if (!std::isfinite(mass * center.normSqr())) {
    throwUnusable({owner, "center_of_mass", "m"}, std::hypot(center[0], center[1], center[2]),
                  "is too far away: the inertia about the body's origin must be finite",
                  body.center_of_mass[0].where);
  }
}

}  // namespace

Vec3 calcVec3(NumberEvaluator& numbers, const Expression3& expressions, const Quantity& quantity) {
  const std::array<double, 3> values = numbers.calc3(expressions, quantity);
  return Vec3(values[0], values[1], values[2]);
}

SimTK::MassProperties calcMassProperties(const BodySpec& body, NumberEvaluator& numbers) {
  const std::string owner = "body '" + body.name.text + "'";
  const double mass = numbers.calcPositive(body.mass, {owner, "mass", "kg"});
  const Vec3 center = calcVec3(numbers, body.center_of_mass, {owner, "center_of_mass", "m"});
  const Vec3 moments = calcVec3(numbers, body.inertia.moments, {owner, "inertia.moments", "kg m2"});
  const Vec3 products = calcVec3(numbers, body.inertia.products, {owner, "inertia.products", "kg m2"});
  checkRange(body, owner, mass, center);
  checkInertia(owner, calcPrincipalMoments(moments, products), body.inertia.moments[0].where);
  SimTK::Inertia about_origin(moments, products);
  about_origin.shiftFromMassCenterInPlace(center, mass);
  return SimTK::MassProperties(mass, center, about_origin);
}

}  // namespace twinmap
