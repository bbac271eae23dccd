#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "framework/estimation/estimate.hpp"

namespace twinmap {

class Hdf5Writer;
struct ForwardSurrogate;
struct ScoreExplanation;

/// A trained estimator: from features and known inputs of a measurement to an estimate of the parameters.
/// Each kind has a folder (gp, surrogate, network), which holds its settings' use, training, inference and
/// file. Immutable, for any number of threads, each with a workspace of its own.
class Estimator {
 public:
  /// The buffers of one thread, and the result.
  class Workspace {
   public:
    virtual ~Workspace() = default;
    /// The point that explains the last measurement best, where the estimator searches it; else null.
    virtual const ScoreExplanation* findExplanation() const { return nullptr; }

    Estimate estimate;
  };

  Estimator() = default;
  Estimator(const Estimator&) = delete;
  Estimator& operator=(const Estimator&) = delete;
  virtual ~Estimator() = default;

  /// As files and tables have it: "gp".
  virtual const char* getKind() const = 0;
  virtual Eigen::Index countFeatures() const = 0;  ///< d
  virtual Eigen::Index countKnown() const = 0;     ///< q, inputs of the set-up
  /// The correlation of the errors of a sample's parameters (p x p), over all samples.
  virtual const Eigen::MatrixXd& getResidualCorrelation() const = 0;
  /// Whether nothing is known against its standard deviations.
  virtual bool isCalibrated() const { return true; }
  /// Whether estimates are mixtures, and whether each has a correlation of its own.
  virtual bool givesMixtures() const { return false; }
  virtual bool givesCorrelations() const { return false; }
  /// Of all its estimates (p x 1); empty where they are those of normal distributions.
  virtual IntervalFactors getIntervalFactors() const { return {}; }
  /// Its own processes from parameters to scores, which judge measurements too; null where it has none.
  virtual std::shared_ptr<const ForwardSurrogate> findForward() const { return nullptr; }

  /// What a report shows of it, where it has that: the length scales of its inputs for each parameter, and
  /// what it projects features by (k x d).
  virtual std::vector<Eigen::VectorXd> listLengthScales() const { return {}; }
  virtual Eigen::MatrixXd getProjection() const;

  virtual std::unique_ptr<Workspace> makeWorkspace() const = 0;
  /// features: d, finite; known: q. The result lies in the workspace, one of this estimator's, until its next
  /// use.
  virtual const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                                const Eigen::Ref<const Eigen::VectorXd>& known,
                                Workspace& workspace) const = 0;
  /// Mean and inputs alone, where that is cheaper; the stddev may be zero.
  virtual const Estimate& inferMean(const Eigen::Ref<const Eigen::VectorXd>& features,
                                    const Eigen::Ref<const Eigen::VectorXd>& known,
                                    Workspace& workspace) const {
    return infer(features, known, workspace);
  }
  /// The separate places (u x n, in the parameters' units) that fit the last measurement of the workspace,
  /// the likeliest first, those of less than a thousandth of the evidence left out; no column where it does
  /// not look for them.
  virtual Eigen::MatrixXd listBasins(const Workspace& workspace) const;
  /// What the inferences' inputs are for features (d x n) and known inputs (q x n).
  virtual Eigen::MatrixXd makeInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const = 0;

  /// Writes all that loading needs below `group` of maps.h5 (trained_file.hpp).
  virtual void save(Hdf5Writer& file, const std::string& group) const = 0;

  /// Mean, standard deviation (p x n) and, where they differ between measurements, correlations for features
  /// (d x n, finite) and known inputs (q x n): those of infer(), bit for bit, for any number of threads.
  /// Throws std::invalid_argument for sizes that do not fit. Cost: that of n inferences.
  Estimates predict(const Eigen::Ref<const Eigen::MatrixXd>& features,
                    const Eigen::Ref<const Eigen::MatrixXd>& known, int threads) const;
};

}  // namespace twinmap
