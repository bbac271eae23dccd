#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// A simulator that deals its batches to all threads that OpenMP offers, each with a clone made when first
/// needed; in a parallel region it simulates by itself. The bits are the same: no column depends on its
/// batch.
class TeamSimulator final : public Simulator {
 public:
  explicit TeamSimulator(std::unique_ptr<Simulator> own);

  const ResponseLayout& getLayout() const override { return getOwn().getLayout(); }
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  int getBatchSize() const override { return getOwn().getBatchSize(); }
  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) override {
    updOwn().simulateAround(parameters, responses, statuses);
  }
  bool mixesNeighbours() const override { return getOwn().mixesNeighbours(); }
  bool hasDerivatives() const override { return getOwn().hasDerivatives(); }
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override {
    return std::make_unique<TeamSimulator>(getOwn().clone());
  }
  std::unique_ptr<Simulator> cloneAt(const Eigen::VectorXd& times) const override {
    std::unique_ptr<Simulator> own = getOwn().cloneAt(times);
    return own ? std::make_unique<TeamSimulator>(std::move(own)) : nullptr;
  }
  const std::string& getEngine() const override { return getOwn().getEngine(); }
  std::vector<std::string> describeModel() override { return updOwn().describeModel(); }
  std::string describeDifferences() override { return updOwn().describeDifferences(); }
  void checkStart() override { updOwn().checkStart(); }
  std::unique_ptr<Simulator> clonePrecisely() const override { return getOwn().clonePrecisely(); }

 private:
  const Simulator& getOwn() const { return *team_.front(); }
  Simulator& updOwn() { return *team_.front(); }
  /// How long a column takes one thread, s; 0: not yet known. least: columns that are worth a thread.
  struct Cost {
    Eigen::Index least;
    double seconds = 0.0;
  };
  /// Simulates columns first ... first + count - 1.
  using Part = std::function<void(Simulator& simulator, Eigen::Index first, Eigen::Index count)>;

  void run(Eigen::Index columns, Cost& cost, const Part& part);
  /// A clone for each thread that is worth while for so many columns; returns how many.
  int makeTeam(Eigen::Index columns, const Cost& cost);

  std::vector<std::unique_ptr<Simulator>> team_;  // the simulator itself first
  Cost cost_, cost_with_derivatives_;
};

/// The simulator as a TeamSimulator where it takes many columns at once, else as it is: others are processes,
/// or slow enough to be seen by their own means.
std::unique_ptr<Simulator> shareAmongThreads(std::unique_ptr<Simulator> simulator);

}  // namespace twinmap
