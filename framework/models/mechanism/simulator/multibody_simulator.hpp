#pragma once

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Whether Simbody builds the model and the recorded equations are compared with it. Where a run starts they
/// are; kTrusted: a run has done so, as where one of its estimators is refined, and lanes then need no
/// Simbody.
enum class ModelCheck { kBySimbody, kTrusted };

/// Simulates a multibody system that is described by data. By default in lanes: the equations of motion are
/// recorded once, compared with Simbody's, and integrated for several samples at a time
/// (docs/explanation/built-in-solver.md); where that is not possible, Simbody builds them anew for every
/// sample. Either integrates by a Dormand-Prince 5(4) pair with dense output. A sample that reaches the step
/// limit in lanes is tried once more by an implicit method (stiff_retry.hpp).
class MultibodySimulator final : public Simulator {
 public:
  /// `times`: where the outputs are sampled, s, strictly increasing within [0, duration]; nothing is
  /// integrated where there are none. `modes`: how many of the lowest modes of the system linearised at each
  /// sample's own static equilibrium, without excitation; a sample with fewer oscillating ones fails.
  /// The model is built once at the centre of the bounds, with the equilibrium if it is asked for
  /// there. Throws ExperimentError for anything wrong with the model that no parameter set can cure: unknown
  /// or doubled names, expressions that do not compile, springs, dampers or force laws on coordinates that
  /// take none, times out of range; and for a system that cannot exist at the box centre, with the place of
  /// the number that is the cause.
  MultibodySimulator(const ModelSpec& model, Eigen::VectorXd times, int modes = 0,
                     ModelCheck check = ModelCheck::kBySimbody);
  ~MultibodySimulator() override;

  const ResponseLayout& getLayout() const override;

  /// "lanes", or "simbody: " and why not lanes.
  const std::string& getEngine() const override;

  int getBatchSize() const override;
  /// Throws ExperimentError unless a simulation at the box centre could begin: the initial state exists, its
  /// equilibrium is found if it has one, and its accelerations are finite. Nothing is integrated; a few ms.
  void checkStart() override;

  /// At the centre of the bounds; equilibrium and modes where lanes simulate.
  std::vector<std::string> describeModel() override;
  /// As Simulator::simulate; throws std::invalid_argument for matrices of the wrong shape. Cost for the
  /// two-beam case: 0.05 ms a sample of 5 s in lanes, 5 ms by Simbody.
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  /// By Simbody. With dopri5, the steps of the centre, scaled with the phases between excitation events; a
  /// column with other phases fails. Simbody's own integrators choose their steps for each column.
  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) override;
  /// In lanes; what reaches the step limit there by differences of solutions by Radau IIA (StiffRetry).
  bool hasDerivatives() const override;
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override;
  /// Null unless signals prescribe all motion, so that nothing is integrated (LaneModel::is_memoryless).
  std::unique_ptr<Simulator> cloneAt(const Eigen::VectorXd& times) const override;
  /// With a hundredth of the tolerances, at least 1e-13 and 1e-18; some 2.5 times the steps of dopri5. The
  /// first call builds and compiles the model once more.
  std::unique_ptr<Simulator> clonePrecisely() const override;

 private:
  class Impl;
  explicit MultibodySimulator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace twinmap
