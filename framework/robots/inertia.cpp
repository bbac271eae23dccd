#include "framework/robots/inertia.hpp"

#include <fmt/core.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::robots {
namespace {

double calcTrace(const Matrix& m) {
  return m.x.x + m.y.y + m.z.z;
}

}  // namespace

MassProperties calcMassProperties(const Inertial& inertial) {
  const Matrix& turn = inertial.frame.rotation;
  return {inertial.mass, inertial.frame.origin, turn * inertial.tensor * algebra::transpose(turn)};
}

std::string describeImpossible(const Matrix& tensor) {
  constexpr double kSlack = 1e-9;  // of the largest moment, as system_numbers.cpp has it
  Eigen::MatrixXd matrix(3, 3);
  matrix << tensor.x.x, tensor.y.x, tensor.z.x, tensor.x.y, tensor.y.y, tensor.z.y, tensor.x.z, tensor.y.z,
      tensor.z.z;
  const Eigen::VectorXd moments = linalg::calcSymmetricEigenvalues(matrix);
  const double slack = kSlack * moments.cwiseAbs().maxCoeff();
  if (moments[0] < -slack) {
    return fmt::format("its smallest principal moment is negative ({:.3g} kg m2)", moments[0]);
  }
  if (moments[2] > moments[0] + moments[1] + slack) {
    return fmt::format(
        "its largest principal moment ({:.3g} kg m2) exceeds the sum of the other two ({:.3g})", moments[2],
        moments[0] + moments[1]);
  }
  return "";
}

Spread calcSpread(const MassProperties& mass) {
  const Matrix& tensor = mass.tensor;
  const Matrix moment =
      algebra::scale(1.0 / mass.mass, algebra::makeDiagonal(0.5 * calcTrace(tensor)) - tensor);
  const auto root = [](double square) { return square > 0.0 ? std::sqrt(square) : 0.0; };
  const auto divide = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
  Spread s;
  s.spread.z = root(moment.z.z);
  s.skew.z = divide(moment.z.y, s.spread.z);
  s.skew.y = divide(moment.z.x, s.spread.z);
  s.spread.y = root(moment.y.y - s.skew.z * s.skew.z);
  s.skew.x = divide(moment.y.x - s.skew.y * s.skew.z, s.spread.y);
  s.spread.x = root(moment.x.x - s.skew.x * s.skew.x - s.skew.y * s.skew.y);
  return s;
}

Matrix calcTensor(double mass, const Spread& s) {
  const Matrix upper{{s.spread.x, 0.0, 0.0}, {s.skew.x, s.spread.y, 0.0}, {s.skew.y, s.skew.z, s.spread.z}};
  const Matrix moment = algebra::scale(mass, upper * algebra::transpose(upper));
  return algebra::makeDiagonal(calcTrace(moment)) - moment;
}

Vector calcAngles(const Matrix& rotation) {
  Vector angles;
  angles.x = std::atan2(-rotation.z.y, rotation.z.z);
  const Matrix rest =
      algebra::rotateX(-angles.x) * rotation;  // rotations about y, then z, whatever the first
  angles.y = std::atan2(rest.z.x, rest.z.z);
  angles.z = std::atan2(rest.x.y, rest.y.y);
  return angles;
}

}  // namespace twinmap::robots
