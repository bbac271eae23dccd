#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/data/reduction/response_reduction.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// A simulator whose long responses are reduced as soon as they are there: some 170 MB of them, with their
/// derivatives, are held at a time.
class ReducedSimulator final : public Simulator {
 public:
  ReducedSimulator(std::unique_ptr<Simulator> whole, std::shared_ptr<const ResponseReduction> reduction);

  const ResponseLayout& getLayout() const override { return reduction_->layout; }
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  int getBatchSize() const override { return whole_->getBatchSize(); }
  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) override;
  bool mixesNeighbours() const override { return whole_->mixesNeighbours(); }
  bool hasDerivatives() const override { return whole_->hasDerivatives(); }
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override;
  const std::string& getEngine() const override { return whole_->getEngine(); }
  std::vector<std::string> describeModel() override { return whole_->describeModel(); }
  std::string describeDifferences() override { return whole_->describeDifferences(); }
  void checkStart() override { whole_->checkStart(); }
  std::unique_ptr<Simulator> clonePrecisely() const override;

 private:
  /// Columns that fit, each with so many derivatives.
  Eigen::Index countAtOnce(Eigen::Index derivatives) const;

  std::unique_ptr<Simulator> whole_;
  std::shared_ptr<const ResponseReduction> reduction_;
};

}  // namespace twinmap
