#pragma once

#include <memory>

#include "framework/estimation/estimator.hpp"
#include "framework/estimation/surrogate/score_inversion.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"

namespace twinmap {

class Hdf5Reader;

/// A surrogate made ready for one measurement after another. Estimates are those of the surrogate, bit for
/// bit. Immutable.
class OnlineSurrogate final : public Estimator {
 public:
  explicit OnlineSurrogate(std::shared_ptr<const Surrogate> surrogate) : surrogate_(std::move(surrogate)) {}

  const Surrogate& getSurrogate() const { return *surrogate_; }

  class Workspace final : public Estimator::Workspace {
   public:
    explicit Workspace(const OnlineSurrogate& map)
        : inversion(*map.surrogate_->forward, map.surrogate_->prior) {
      estimate.estimator = map.getKind();
      estimate.correlation = map.surrogate_->validation.residual_correlation;
    }
    const ScoreExplanation* findExplanation() const override { return inversion.findExplanation(); }

   private:
    friend class OnlineSurrogate;
    ScoreInversion inversion;
  };

  const char* getKind() const override { return "surrogate"; }
  Eigen::Index countFeatures() const override { return surrogate_->forward->center.size(); }
  Eigen::Index countKnown() const override { return surrogate_->center.size() - surrogate_->unknown; }
  const Eigen::MatrixXd& getResidualCorrelation() const override {
    return surrogate_->validation.residual_correlation;
  }
  bool isCalibrated() const override { return surrogate_->validation.status == SurrogateStatus::kOk; }
  std::shared_ptr<const ForwardSurrogate> findForward() const override { return surrogate_->forward; }
  std::unique_ptr<Estimator::Workspace> makeWorkspace() const override {
    return std::make_unique<Workspace>(*this);
  }
  /// The inputs of the result are the scores and the normalised known inputs. Cost: that of
  /// ScoreInversion::infer().
  const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                        const Eigen::Ref<const Eigen::VectorXd>& known,
                        Estimator::Workspace& workspace) const override;
  /// The minima of the last inference.
  Eigen::MatrixXd listBasins(const Estimator::Workspace& workspace) const override;
  Eigen::MatrixXd makeInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const override;
  void save(Hdf5Writer& file, const std::string& group) const override;

 private:
  std::shared_ptr<const Surrogate> surrogate_;
};

/// Reads what save() wrote. Errors as of readSurrogate().
std::shared_ptr<const Estimator> loadSurrogate(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
