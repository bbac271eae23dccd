#pragma once

#include "framework/estimation/refined/measured_misfit.hpp"
#include "framework/estimation/refined/search_box.hpp"
#include "framework/estimation/segments/segmented_recording.hpp"
#include "framework/estimation/segments/state_elimination.hpp"

namespace twinmap {

/// Of a recording in segments, the state at the start of each eliminated: the misfit is that at the best
/// states, which Gauss and Newton's method finds for every point, from where the linear model at the nearest
/// point before says. No logarithm of a determinant is added: with as many states as segments, what a flat
/// prior of the states says of the parameters would outweigh the data, while the score of the best states is
/// without bias where the response is linear in them. Segments of all points go through the lanes together.
class SegmentedMisfit final : public MeasuredMisfit {
 public:
  /// All must outlive the object. The simulator has derivatives.
  SegmentedMisfit(Simulator& simulator, const SegmentedRecording& recording);

  int getSimulations() const override { return simulations_; }
  /// LocalMisfit::residual: those of StateElimination, one segment after the other.
  std::vector<LocalMisfit> linearizeAll(const Eigen::MatrixXd& points) override;
  Eigen::VectorXd evaluate(const Eigen::MatrixXd& points) override;

 private:
  /// What one segment says at one point.
  struct SegmentFit {
    Eigen::Index point = 0, segment = 0;
    Eigen::VectorXd state;          ///< at which it is simulated next
    Eigen::VectorXd accepted;       ///< the best so far; empty: none
    double misfit = 0.0;            ///< there
    StateElimination local{};       ///< there; without the jacobian
    Eigen::MatrixXd information{};  ///< u x u
    Eigen::VectorXd descent{};      ///< u
    Eigen::Index residuals = 0;     ///< samples that are there
    SampleStatus status{};
    bool active = true;
  };

  /// Where the best states are about a point.
  struct Anchor {
    Eigen::VectorXd at;                   ///< u
    Eigen::MatrixXd states;               ///< s x S
    std::vector<Eigen::MatrixXd> slopes;  ///< s x u of each segment
  };

  std::vector<SegmentFit> fitAll(const Eigen::MatrixXd& points);
  template <class Action>
  void fitEach(const Eigen::MatrixXd& points, Action action);
  Eigen::MatrixXd predictStates(const Eigen::VectorXd& at) const;
  void simulate(const Eigen::MatrixXd& points, const std::vector<SegmentFit*>& fits);
  void update(const Eigen::VectorXd& response, const Eigen::MatrixXd& derivatives, SegmentFit& fit) const;
  void retreat(SegmentFit& fit) const;
  LocalMisfit combine(const Eigen::VectorXd& at, const SegmentFit* fits) const;
  void remember(const Eigen::VectorXd& at, const SegmentFit* fits);

  Simulator& simulator_;
  const SegmentedRecording& recording_;
  const SearchBox box_;
  const StatePrior prior_;  // ahead: 0
  std::vector<Anchor> anchors_;
  std::size_t oldest_ = 0;
  int simulations_ = 0;
};

}  // namespace twinmap
