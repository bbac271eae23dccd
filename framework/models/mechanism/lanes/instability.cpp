#include "framework/models/mechanism/lanes/instability.hpp"

#include <fmt/format.h>

#include <complex>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// The one with the largest real part.
std::complex<double> findFastest(const VectorXcd& eigenvalues) {
  Index fastest = 0;
  eigenvalues.real().maxCoeff(&fastest);
  return eigenvalues[fastest];
}

/// Of unit length: what A - lambda shortens most, in real numbers.
VectorXcd calcEigenvector(const MatrixXd& matrix, const std::complex<double>& eigenvalue) {
  const Index n = matrix.rows();
  const MatrixXd identity = MatrixXd::Identity(n, n);
  MatrixXd real(2 * n, 2 * n);
  real << matrix - eigenvalue.real() * identity, eigenvalue.imag() * identity, -eigenvalue.imag() * identity,
      matrix - eigenvalue.real() * identity;
  const VectorXd vector = linalg::calcSymmetricEigen(real.transpose() * real).vectors.col(0);
  return vector.head(n) + std::complex<double>(0.0, 1.0) * vector.tail(n);
}

GrowthCause findCause(const MatrixXd& matrix, const VectorXcd& z) {
  const Index n = z.size();
  const auto calcShare = [&](const MatrixXd& forces) {
    return z.dot(forces.cast<std::complex<double>>() * z).real();
  };
  return calcShare(matrix.block(n, 0, n, n)) > 0.0   ? GrowthCause::kStiffness
         : calcShare(matrix.block(n, n, n, n)) > 0.0 ? GrowthCause::kDamping
                                                     : GrowthCause::kCoupling;
}

/// Places of coefficients below 0.
void addNegative(const Expression& coefficient, ModelContext& context, std::vector<std::string>& places) {
  if (context.numbers.calc(coefficient, {"element", "coefficient", ""}) < 0.0) {
    places.push_back(toString(coefficient.where));
  }
}

/// What may have the wrong sign.
std::vector<std::string> listSuspects(const Instability& instability, ModelContext& context) {
  const ForceElements<Expression>& elements = context.model.system.elements;
  std::vector<std::string> places;
  for (const Spring<Expression>& spring : elements.get<Spring>()) {
    addNegative(spring.stiffness, context, places);
  }
  for (const TwoPointSpring<Expression>& spring : elements.get<TwoPointSpring>()) {
    addNegative(spring.stiffness, context, places);
  }
  for (const Damper<Expression>& damper : elements.get<Damper>()) {
    addNegative(damper.damping, context, places);
  }
  for (const TwoPointDamper<Expression>& damper : elements.get<TwoPointDamper>()) {
    addNegative(damper.damping, context, places);
  }
  const std::string& moves =
      context.names.getCoordinateNames()[static_cast<std::size_t>(instability.coordinate)];
  for (const ForceLaw<Expression>& law : elements.get<ForceLaw>()) {
    if (places.empty() && law.coordinate.text == moves) {
      places.push_back(toString(law.force.where));
    }
  }
  return places;
}

}  // namespace

std::optional<Instability> findInstability(const MatrixXd& matrix, Index coordinates) {
  constexpr double kRounding = 1e-6;  // of the largest; double eigenvalues of 0 are as wrong as 1e-8 of it
  if (matrix.size() == 0 || !matrix.allFinite()) {
    return std::nullopt;
  }
  const VectorXcd eigenvalues = linalg::calcEigenvalues(matrix);
  const std::complex<double> fastest = findFastest(eigenvalues);
  if (fastest.real() <= kRounding * eigenvalues.cwiseAbs().maxCoeff()) {
    return std::nullopt;
  }
  const VectorXcd z = calcEigenvector(matrix, fastest).head(coordinates);
  Instability found{fastest.real(), 0, findCause(matrix, z)};
  if (coordinates > 0) {
    z.cwiseAbs().maxCoeff(&found.coordinate);
  }
  return found;
}

std::string describeInstability(const Instability& instability, ModelContext& context) {
  const std::string& moves =
      context.names.getCoordinateNames()[static_cast<std::size_t>(instability.coordinate)];
  const std::vector<std::string> suspects = listSuspects(instability, context);
  const char* cause = instability.cause == GrowthCause::kStiffness ? ", as a force rises with it"
                      : instability.cause == GrowthCause::kDamping ? ", as a force rises with its speed"
                                                                   : "";
  return fmt::format("{} grows e-fold in {:.2g} s{}; look at {}", moves, 1.0 / instability.rate, cause,
                     suspects.empty() ? "the direction of gravity"
                                      : fmt::format("the sign of {}", fmt::join(suspects, ", ")));
}

}  // namespace twinmap
