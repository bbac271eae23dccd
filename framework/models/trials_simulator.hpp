#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Several trials of one machine as one simulation (ModelSpec::trials): each by its own simulator, at all
/// times up to its own duration. Later rows of its outputs repeat the last; no feature reads them.
class TrialsSimulator final : public Simulator {
 public:
  using Maker = std::function<std::unique_ptr<Simulator>(const ModelSpec&, const Eigen::VectorXd&, int)>;

  /// make: the simulator of a trial's model at its times with its modes.
  TrialsSimulator(const ModelSpec& model, const Eigen::VectorXd& times, int modes, const Maker& make);

  const ResponseLayout& getLayout() const override { return layout_; }
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  int getBatchSize() const override;
  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) override;
  bool mixesNeighbours() const override;
  bool hasDerivatives() const override;
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override;
  const std::string& getEngine() const override { return engine_; }
  std::vector<std::string> describeModel() override { return trials_.front().simulator->describeModel(); }
  std::string describeDifferences() override;
  void checkStart() override;
  std::unique_ptr<Simulator> clonePrecisely() const override;

 private:
  struct Trial {
    std::string name;
    std::unique_ptr<Simulator> simulator;
    std::vector<Eigen::Index> sampled;  ///< of the whole point
    Eigen::Index first_output = 0;
  };

  TrialsSimulator(const TrialsSimulator& other, std::vector<Trial> trials);
  /// Simulates each trial by `run` and puts its rows in their places.
  template <class Run>
  void simulateEach(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                    Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses, const Run& run);
  /// Rows of a trial (columns: any) among those of all.
  void place(const Trial& trial, const Eigen::Ref<const Eigen::MatrixXd>& own,
             Eigen::Ref<Eigen::MatrixXd> all) const;

  ResponseLayout layout_;
  std::vector<Trial> trials_;
  std::string engine_;
};

}  // namespace twinmap
