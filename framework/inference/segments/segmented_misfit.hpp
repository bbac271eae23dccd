#pragma once

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/estimation/refined/measured_misfit.hpp"
#include "framework/estimation/refined/search_box.hpp"
#include "framework/inference/segments/state_elimination.hpp"

namespace twinmap {

/// A recording cut into segments of equal length, each of which starts at a state of its own. Segments are
/// simulated at points [parameters u; state s; known inputs q; the segment's start in the recording].
struct SegmentedRecording {
  std::vector<ParameterSpec> unknown;    ///< u, the same in all segments
  Eigen::VectorXd known;                 ///< q
  FeatureExtractor extractor;            ///< of a segment's samples, linear in the response
  std::vector<NoiseWhitener> whiteners;  ///< of each segment, or one of all
  std::vector<Eigen::Index> order;       ///< whitened rows, in the order of time
  Eigen::MatrixXd features;              ///< d x S, NaN where missing
  Eigen::VectorXd starts;                ///< S, s
  Eigen::MatrixXd states;                ///< s x S, about where they are
  Eigen::VectorXd scales;                ///< s, how far a state may be from there

  const NoiseWhitener& getWhitener(Eigen::Index segment) const {
    return whiteners.size() == 1 ? whiteners.front() : whiteners[static_cast<std::size_t>(segment)];
  }
};

/// What is known of a state beside the samples: so many scales are its standard deviation. A state that the
/// samples do not tell stays where it is; one that they tell is not moved by more than a hundredth of its own
/// standard deviation unless that is above 1.4 scales.
constexpr double kStateScales = 10.0;

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
  /// Without derivatives: the response moves with the states as at the nearest point that was linearised.
  Eigen::VectorXd evaluate(const Eigen::MatrixXd& points) override;

  /// The best states at parameters in their units, s x S; without columns where they cannot be simulated.
  Eigen::MatrixXd findStates(const Eigen::VectorXd& parameters);

 private:
  /// A segment at the best state of a point: what another point begins with.
  struct BestState {
    Eigen::VectorXd state;     ///< s
    Eigen::MatrixXd slopes;    ///< s x u
    Eigen::MatrixXd by_state;  ///< n x s, of the whitened response
    Eigen::MatrixXd hessian;   ///< s x s, lower Cholesky factor of that of the misfit
  };

  /// Where the best states are about a point.
  struct Anchor {
    Eigen::VectorXd at;           ///< u
    std::vector<BestState> best;  ///< S
  };

  /// What one segment says at one point.
  struct SegmentFit {
    Eigen::Index point = 0, segment = 0;
    const BestState* near = nullptr;  ///< null: of no point before
    Eigen::VectorXd state;            ///< at which it is simulated next
    Eigen::VectorXd accepted;         ///< the best so far; empty: none
    double misfit = 0.0;              ///< there
    StateElimination local{};         ///< there; step and gain alone without derivatives
    Eigen::MatrixXd by_state{};       ///< there, with derivatives
    SampleStatus status{};
    bool active = true;
  };

  const Anchor* findNearest(const Eigen::VectorXd& at) const;
  std::vector<SegmentFit> begin(const Eigen::MatrixXd& points) const;
  void improve(const Eigen::MatrixXd& points, bool with_derivatives, std::vector<SegmentFit>& fits);
  void simulate(const Eigen::MatrixXd& points, bool with_derivatives, const std::vector<SegmentFit*>& fits);
  void update(const Eigen::VectorXd& response, const Eigen::MatrixXd& derivatives, SegmentFit& fit) const;
  void takeStep(const Eigen::VectorXd& residual, const Eigen::MatrixXd& derivatives, SegmentFit& fit) const;
  void retreat(SegmentFit& fit) const;
  Eigen::VectorXd calcAhead(const SegmentFit& fit) const;
  Eigen::VectorXd limit(const Eigen::VectorXd& state, Eigen::Index segment) const;
  LocalMisfit combine(const Eigen::VectorXd& at, const SegmentFit* fits) const;
  void remember(const Eigen::VectorXd& at, SegmentFit* fits);
  /// action(i, fits of point i), few points at a time: what their segments say takes memory.
  template <class Action>
  void fitEach(const Eigen::MatrixXd& points, bool with_derivatives, Action action);

  Simulator& simulator_;
  const SegmentedRecording& recording_;
  const SearchBox box_;
  const Eigen::VectorXd precision_;  // s, of the states before anything is measured
  const Eigen::Index samples_;       // that are there
  const std::size_t kept_;           // anchors
  std::vector<Anchor> anchors_;
  std::size_t oldest_ = 0;
  int simulations_ = 0;
};

}  // namespace twinmap
