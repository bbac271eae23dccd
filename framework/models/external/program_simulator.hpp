#pragma once

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulates a model that is a program (docs/how-to/use-a-program.md). Each thread that simulates has one of
/// its own, started once and kept. What happens to it, a crash, an end, a hang, is a failed sample: first,
/// but for a hang, the sample is tried again in a fresh process, so that what other samples did there decides
/// nothing.
class ProgramSimulator final : public Simulator {
 public:
  /// Starts nothing. `times`: of the outputs, s, increasing, within [0, duration]. Throws ExperimentError for
  /// names declared twice, expressions that do not compile, and for modes, which a program has not.
  ProgramSimulator(const ModelSpec& model, Eigen::VectorXd times, int modes);
  ~ProgramSimulator() override;

  const ResponseLayout& getLayout() const override;
  const std::string& getEngine() const override;
  int getBatchSize() const override;
  bool mixesNeighbours() const override { return true; }

  /// Starts the program and simulates the centre of the box. Throws ExperimentError where that fails.
  void checkStart() override;

  /// As Simulator::simulate; throws ExperimentError where the program can never be started. Some 60 us a
  /// sample of 200 values beside the program's own time.
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override;

 private:
  class Shared;
  class Sampler;
  explicit ProgramSimulator(std::shared_ptr<Shared> shared);

  void simulateBatch(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                     Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses);
  void finish(const Eigen::Ref<const Eigen::VectorXd>& point, Eigen::Ref<Eigen::VectorXd> response,
              SampleStatus& status);

  std::shared_ptr<Shared> shared_;
  std::unique_ptr<Sampler> sampler_;
};

}  // namespace twinmap
