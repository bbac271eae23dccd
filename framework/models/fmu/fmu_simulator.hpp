#pragma once

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/difference_steps.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulates a model that comes as an FMU (docs/how-to/use-an-fmu.md). Each clone that simulates has the FMU
/// in a process of its own, which its successors use again: what happens to it there, a crash, an end, a
/// hang, is a failed sample.
class FmuSimulator final : public Simulator {
 public:
  /// Unpacks the FMU and finds the model's names among its variables; starts nothing. `times`: of the
  /// outputs, s, increasing, within [0, duration]. Throws ExperimentError for an FMU that cannot be used, a
  /// name or unit that does not fit, and for modes, which an FMU has not.
  FmuSimulator(const ModelSpec& model, Eigen::VectorXd times, int modes);
  ~FmuSimulator() override;

  const ResponseLayout& getLayout() const override;
  const std::string& getEngine() const override;
  /// Simulates the centre of the box.
  void checkStart() override;
  /// Some 20 us a sample beside the FMU's own time.
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  /// With the steps of the centre where it has no state events, for Model Exchange. Where the responses are
  /// noisy, on the tangent at the centre: the noise is measured once a model, at the centre of the box.
  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) override;
  /// Whether the FMU offers directional derivatives by all parameters (fmi/sensitivity_plan.hpp).
  bool hasDerivatives() const override;
  /// By the FMU's directional derivatives along the steps of the simulation. By differences of neighbours
  /// with these steps at points where an event intervenes, and everywhere if those of the FMU are not the
  /// same at the centre of the box.
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) override;
  std::string describeDifferences() override;
  std::unique_ptr<Simulator> clone() const override;
  /// With a hundredth of the tolerances, which Model Exchange is integrated with and Co-Simulation told.
  std::unique_ptr<Simulator> clonePrecisely() const override;

 private:
  class Shared;
  class Worker;
  explicit FmuSimulator(std::shared_ptr<Shared> shared);

  void checkShapes(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                   const Eigen::Ref<Eigen::MatrixXd>& responses) const;
  const DifferenceSteps& getDifferenceSteps();
  /// In one exchange with the process.
  void simulateTogether(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                        Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses);

  /// `exchange(worker)`, once more with a new worker where one fails that samples before may have harmed; a
  /// failure is the `count` statuses.
  template <class Exchange>
  void attempt(const Exchange& exchange, SampleStatus* statuses, Eigen::Index count);

  std::shared_ptr<Shared> shared_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace twinmap
