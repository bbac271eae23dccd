#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// A simulator whose batches a team of threads shares, as many as OpenMP offers: for one inference at a time.
/// Within a parallel region it is the simulator itself. Responses are the same, as no column depends on its
/// batch.
class ParallelSimulator final : public Simulator {
 public:
  explicit ParallelSimulator(std::unique_ptr<Simulator> simulator);

  const ResponseLayout& getLayout() const override { return first().getLayout(); }
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  int getBatchSize() const override { return first().getBatchSize(); }
  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) override {
    first().simulateAround(parameters, responses, statuses);
  }
  bool mixesNeighbours() const override { return first().mixesNeighbours(); }
  bool hasDerivatives() const override { return first().hasDerivatives(); }
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override;
  const std::string& getEngine() const override { return first().getEngine(); }
  std::vector<std::string> describeModel() override { return first().describeModel(); }
  std::string describeDifferences() override { return first().describeDifferences(); }
  void checkStart() override { first().checkStart(); }
  std::unique_ptr<Simulator> clonePrecisely() const override;

 private:
  Simulator& first() const { return *simulators_.front(); }
  /// Calls task(simulator, first column, columns) for parts of so many columns.
  template <class Task>
  void share(Eigen::Index columns, const Task& task);

  std::vector<std::unique_ptr<Simulator>> simulators_;  // of each thread
};

}  // namespace twinmap
