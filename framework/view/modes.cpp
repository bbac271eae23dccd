#include "framework/view/modes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/lanes/lane_modes.hpp"
#include "framework/models/mechanism/lanes/lane_programs.hpp"
#include "framework/models/mechanism/sampled_keys.hpp"
#include "framework/simulation/simulation_failure.hpp"
#include "framework/view/point_values.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap::view {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

constexpr int kSteps = 24;     // of a period
constexpr double kTurn = 0.3;  // rad, of the largest amplitude; of a length that share of the mechanism

/// The coordinates (n) of an eigenvector of A, by inverse iteration: (A - s) x = y in real and imaginary
/// parts, with s beside the eigenvalue.
Eigen::VectorXcd calcShape(const MatrixXd& a, const Complex& eigenvalue, Index n) {
  const Index size = a.rows();
  const Complex near = eigenvalue * (1.0 + 1e-8);
  MatrixXd both(2 * size, 2 * size);
  const MatrixXd unit = MatrixXd::Identity(size, size);
  both << a - near.real() * unit, near.imag() * unit, -near.imag() * unit, a - near.real() * unit;
  VectorXd x = VectorXd::LinSpaced(2 * size, 1.0, 2.0);
  for (int i = 0; i < 3; ++i) {
    x = linalg::solveLinear(both, x);
    x /= x.cwiseAbs().maxCoeff();
  }
  Eigen::VectorXcd shape(n);
  for (Index i = 0; i < n; ++i) {
    shape[i] = {x[i], x[size + i]};
  }
  return shape;
}

class ModeDrawer {
 public:
  ModeDrawer(const ModelSpec& model, const VectorXd& point, Scene& scene) : at_(model, point), scene_(scene) {
    for (const SceneBody& body : scene.bodies) {
      const Vector &reach = body.in_parent.origin, &radii = body.ellipsoid.radii;
      size_ = std::max({size_, std::sqrt(algebra::dot(reach, reach)), std::sqrt(algebra::dot(radii, radii))});
    }
  }

  void add(const MatrixXd& matrix, const VectorXd& equilibrium) {
    const Index n = static_cast<Index>(at_.names.getCoordinateNames().size());
    const Eigen::VectorXcd eigenvalues = linalg::calcEigenvalues(matrix);
    const double least = 1e-5 * eigenvalues.cwiseAbs().maxCoeff();  // as calcModes
    for (const Complex& eigenvalue : eigenvalues) {
      if (eigenvalue.imag() > least) {
        const double size = std::abs(eigenvalue);
        scene_.modes.push_back({size / (2.0 * std::acos(-1.0)), -eigenvalue.real() / size,
                                draw(calcShape(matrix, eigenvalue, n), equilibrium)});
      }
    }
    std::sort(scene_.modes.begin(), scene_.modes.end(),
              [](const SceneMode& a, const SceneMode& b) { return a.frequency < b.frequency; });
  }

 private:
  std::vector<std::vector<Pose>> draw(const Eigen::VectorXcd& shape, const VectorXd& equilibrium) const {
    double largest = 0.0;  // in turns and lengths of the mechanism
    for (Index i = 0; i < shape.size(); ++i) {
      const CoordinatePlace& place = at_.names.getCoordinates()[static_cast<std::size_t>(i)];
      const bool is_angle = place.traits.kind == CoordinateKind::kRotation;
      largest = std::max(largest, std::abs(shape[i]) / (is_angle ? 1.0 : size_));
    }
    std::vector<std::vector<Pose>> frames;
    for (int step = 0; step <= kSteps; ++step) {
      const Complex turn = std::polar(kTurn / largest, 2.0 * std::acos(-1.0) * step / kSteps);
      std::vector<double> q;
      for (Index i = 0; i < shape.size(); ++i) {
        q.push_back(equilibrium[i] + (turn * shape[i]).real());
      }
      frames.push_back(calcPoses(at_.values, q));
    }
    return frames;
  }

  const PointValues at_;
  Scene& scene_;
  double size_ = 1e-6;  // m
};

}  // namespace

void addModes(const ModelSpec& model, const VectorXd& point, Scene& scene) {
  if (model.source || !model.system.constraints.empty() || !model.system.motions.empty()) {
    return;
  }
  const ModelSpec completed = addControllerStates(model);
  ModelContext context(completed);
  LanePrograms programs(context, nullptr);
  if (!programs.getObstacle().empty()) {
    return;
  }
  const LaneModel& lanes = programs.getValues();
  if (!lanes.isDifferentiated()) {
    scene.remarks.push_back(
        fmt::format("no modes: they are sought of at most {} coordinates", kMostDifferentiated));
    return;
  }
  try {
    const VectorXd center = solveBoxCenter(context, lanes), none;
    const VectorXd equilibrium = LaneStart(completed, lanes, center, none).solveEquilibrium(point);
    ModeDrawer(model, point, scene).add(LaneModes(lanes).calcMatrix(point, equilibrium), equilibrium);
  } catch (const SimulationFailure&) {
    scene.modes.clear();  // it does not rest anywhere near
  }
}

}  // namespace twinmap::view
