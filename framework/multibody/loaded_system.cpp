#include "framework/multibody/loaded_system.hpp"

#include <Eigen/Cholesky>

namespace twinmap {
namespace {

/// A pivot below this part of its diagonal entry makes the mass matrix singular.
constexpr double kSingularPivot = 1e-13;

/// Shows the forces of a loaded system to Simbody's own integrators.
class ForceAdapter : public SimTK::Force::Custom::Implementation {
 public:
  explicit ForceAdapter(LoadedSystem& system) : system_(system) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector& mobility_forces) const override {
    system_.calcForces(state, state.getTime(), body_forces, mobility_forces);
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  LoadedSystem& system_;
};

/// Overwrites `solution` (right-hand side) with the solution, `matrix` with its factor.
void solveInPlace(Eigen::Map<Eigen::MatrixXd> matrix, Eigen::Map<Eigen::VectorXd> solution) {
  const Eigen::Index n = matrix.rows();
  const auto tooSmall = [&matrix](double pivot, Eigen::Index i) {
    return !(pivot > kSingularPivot * matrix(i, i));
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    const double pivot = matrix(j, j) - matrix.row(j).head(j).squaredNorm();
    if (tooSmall(pivot, j)) {
      throw SimulationFailure("the mass matrix is singular: a body without inertia can move freely");
    }
    matrix(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < n; ++i) {
      matrix(i, j) = (matrix(i, j) - matrix.row(i).head(j).dot(matrix.row(j).head(j))) / matrix(j, j);
    }
  }
  matrix.triangularView<Eigen::Lower>().solveInPlace(solution);
  matrix.triangularView<Eigen::Lower>().transpose().solveInPlace(solution);
}

}  // namespace

ModelContext::ModelContext(const ModelSpec& spec)
    : model(spec),
      names(spec.system),
      numbers(spec),
      loads(spec, names, numbers.getScope()),
      excitation(spec.excitation) {}

LoadedSystem::LoadedSystem(ModelContext& context, bool for_simbody)
    : context_(context),
      tree_(context.model.system, context.names, context.numbers.updNumbers()),
      passive_(calcPassiveForces(context.model.system, context.names, context.numbers.updNumbers())),
      signals_(context.excitation.getSignalCount(), 0.0) {
  context.loads.update(context.numbers.getScope(), context.numbers.updNumbers());
  context.excitation.update(context.numbers.updNumbers());
  if (for_simbody) {
    tree_.addForce(new ForceAdapter(*this));
  }
  tree_.realize();
  const int speeds = tree_.getDefaultState().getNU();
  body_forces_.resize(tree_.getMatter().getNumBodies());
  mobility_forces_.resize(speeds);
  residual_.resize(speeds);
  udot_.resize(speeds);
  mass_matrix_.resize(speeds, speeds);
}

void LoadedSystem::calcForces(const SimTK::State& state, double t,
                              SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                              SimTK::Vector& mobility_forces) {
  body_forces.setToZero();
  mobility_forces.setToZero();
  ForceSum sum(tree_, state, body_forces, mobility_forces);
  addPassiveForces(passive_, sum);
  context_.excitation.calcValues(t, signals_);
  context_.loads.add(t, signals_, sum);
}

const SimTK::Vector& LoadedSystem::calcUDot(const SimTK::State& state, double t) {
  const int n = udot_.size();
  if (n == 0) {
    return udot_;
  }
  calcForces(state, t, body_forces_, mobility_forces_);
  const SimTK::SimbodyMatterSubsystem& matter = tree_.getMatter();
  matter.calcResidualForceIgnoringConstraints(state, mobility_forces_, body_forces_, zero_udot_, residual_);
  matter.calcM(state, mass_matrix_);
  for (int i = 0; i < n; ++i) {
    udot_[i] = -residual_[i];
  }
  solveInPlace(Eigen::Map<Eigen::MatrixXd>(&mass_matrix_(0, 0), n, n),
               Eigen::Map<Eigen::VectorXd>(&udot_[0], n));
  return udot_;
}

}  // namespace twinmap
