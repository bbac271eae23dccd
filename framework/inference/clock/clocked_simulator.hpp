#pragma once

#include <array>
#include <memory>
#include <vector>

#include "framework/inference/clock/clock_fault.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// A simulator whose responses are read by a clock with faults: the sizes of these are parameters, behind
/// `before` of the model's own and before the others. About the sizes that it is made for, a response at a
/// stamp is the parabola through the responses at the time that they lead to and `reach` on either side, so
/// that other sizes are good as long as they lead to times within about that reach. Stamps that lead to
/// before the first or behind the last time that can be simulated have the response there (isWithin).
class ClockedSimulator final : public Simulator {
 public:
  /// The times (s) that the inner simulator needs.
  struct Times {
    Eigen::VectorXd stamps;  ///< increasing
    std::vector<NuisanceSize> faults;
    double reach = 0.0;     ///< s
    double duration = 0.0;  ///< s

    /// The true time of a stamp, moved to within what can be simulated.
    double calcTrueTime(double stamp) const;
    bool isWithin(double stamp) const;
    Eigen::VectorXd listAll() const;
  };

  /// inner: at Times::listAll(). before: of its parameters, those before the clock's.
  ClockedSimulator(std::unique_ptr<Simulator> inner, Times times, Eigen::Index before);

  const ResponseLayout& getLayout() const override { return layout_; }
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) override;
  bool mixesNeighbours() const override { return inner_->mixesNeighbours(); }
  int getBatchSize() const override { return inner_->getBatchSize(); }
  bool hasDerivatives() const override { return inner_->hasDerivatives(); }
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override;
  const std::string& getEngine() const override { return inner_->getEngine(); }
  void checkStart() override { inner_->checkStart(); }

 private:
  /// The parabola's weights of the rows of the inner response.
  struct Weights {
    double before, at, after;
  };

  Eigen::MatrixXd takeInner(const Eigen::Ref<const Eigen::MatrixXd>& parameters) const;
  void combine(const Eigen::Ref<const Eigen::MatrixXd>& inner,
               const Eigen::Ref<const Eigen::MatrixXd>& parameters,
               Eigen::Ref<Eigen::MatrixXd> responses) const;
  /// How much later than by the faults a stamp's lateness is with these sizes (k).
  double calcMore(Eigen::Index time, const Eigen::Ref<const Eigen::VectorXd>& sizes) const;
  Weights calcWeights(double shift) const;
  Weights calcSlopes(double shift) const;
  double apply(const Weights& weights, const Eigen::Ref<const Eigen::VectorXd>& inner, Eigen::Index output,
               Eigen::Index time) const;

  std::unique_ptr<Simulator> inner_;
  const Times times_;
  const Eigen::Index before_;
  ResponseLayout layout_;
  Eigen::MatrixXd shapes_;  // stamps x faults
  /// Of each stamp, the inner times before, at and after.
  std::vector<std::array<Eigen::Index, 3>> nodes_;
};

}  // namespace twinmap
