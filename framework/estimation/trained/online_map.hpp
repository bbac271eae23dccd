#pragma once

#include <Eigen/Core>
#include <memory>
#include <variant>

#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"

namespace twinmap {

/// A trained map of any kind, as values.
using AnyMap = std::variant<GpMap, std::shared_ptr<const Surrogate>, std::shared_ptr<const NetworkMap>>;

/// A trained map made ready for one measurement after another. Immutable.
class OnlineMap {
 public:
  explicit OnlineMap(AnyMap map);

  /// Whether nothing is known against the map's standard deviations (SurrogateStatus).
  bool isCalibrated() const;

  /// The correlation of the errors of a sample's parameters, p x p, over all samples.
  const Eigen::MatrixXd& getResidualCorrelation() const;

  /// Whether inferences are mixtures.
  bool givesMixtures() const;

  /// Null where the map is of another kind.
  const Surrogate* findSurrogate() const;

  /// The buffers of one thread, and the result.
  class Workspace {
   public:
    explicit Workspace(const OnlineMap& map);

    /// Where the map is a surrogate, the point that explains the last measurement best by it
    /// (ScoreInversion::findExplanation()); else null.
    const ScoreExplanation* findExplanation() const;

   private:
    friend class OnlineMap;
    std::variant<OnlineProcesses::Workspace, OnlineSurrogate::Workspace, OnlineNetwork::Workspace> kind;
  };

  /// Where the map is a surrogate, the separate places (u x n, in the parameters' units) that fit the last
  /// measurement of the workspace, the likeliest first, those of less than a thousandth of the evidence left
  /// out; else no column.
  Eigen::MatrixXd listBasins(const Workspace& workspace) const;

  /// features: d, finite; known: the inputs of the set-up (q). The result lies in the workspace until its
  /// next use. Cost: some 10 us for the processes of four parameters, a ms by a surrogate, some us by a
  /// network.
  const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                        const Eigen::Ref<const Eigen::VectorXd>& known, Workspace& workspace) const;
  /// Mean and inputs alone, where that is cheaper; the stddev may be zero.
  const Estimate& inferMean(const Eigen::Ref<const Eigen::VectorXd>& features,
                            const Eigen::Ref<const Eigen::VectorXd>& known, Workspace& workspace) const;

  /// Mean, standard deviation (p x n) and, where they differ between measurements, correlations for features
  /// (d x n, finite) and known inputs (q x n): those of infer(), bit for bit, for any number of threads.
  /// Throws std::invalid_argument for sizes that do not fit. Cost: that of n inferences.
  Estimates predict(const Eigen::Ref<const Eigen::MatrixXd>& features,
                    const Eigen::Ref<const Eigen::MatrixXd>& known, int threads) const;

  /// What the inferences' inputs are for features (d x n) and known inputs (q x n).
  Eigen::MatrixXd makeInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const;

 private:
  std::variant<OnlineProcesses, OnlineSurrogate, OnlineNetwork> kind_;
};

}  // namespace twinmap
