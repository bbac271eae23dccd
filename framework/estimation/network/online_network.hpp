#pragma once

#include <memory>

#include "framework/estimation/estimator.hpp"
#include "framework/estimation/network/network_map.hpp"
#include "kernels/linalg/paired_matrix.hpp"
#include "kernels/network/ensemble.hpp"

namespace twinmap {

class Hdf5Reader;

/// A network made ready for one measurement after another. Estimates are those of the map, whose numbers
/// are rounded already, up to rounding of sums.
/// Immutable.
class OnlineNetwork final : public Estimator {
 public:
  explicit OnlineNetwork(std::shared_ptr<const NetworkMap> map)
      : map_(std::move(map)), projection_(map_->inputs.projection), predictor_(map_->members) {}

  const NetworkMap& getMap() const { return *map_; }

  class Workspace final : public Estimator::Workspace {
   public:
    explicit Workspace(const OnlineNetwork& map);

   private:
    friend class OnlineNetwork;
    network::EnsemblePredictor::Workspace predicting;
    Eigen::VectorXd centered;
  };

  const char* getKind() const override { return "network"; }
  Eigen::Index countFeatures() const override { return map_->inputs.center.size(); }
  Eigen::Index countKnown() const override { return map_->inputs.known.center.size(); }
  const Eigen::MatrixXd& getResidualCorrelation() const override {
    return map_->validation.residual_correlation;
  }
  bool isCalibrated() const override { return map_->validation.status == SurrogateStatus::kOk; }
  bool givesMixtures() const override { return map_->countComponents() > 1; }
  bool givesCorrelations() const override { return true; }
  IntervalFactors getIntervalFactors() const override { return map_->validation.interval_factors; }
  std::unique_ptr<Estimator::Workspace> makeWorkspace() const override {
    return std::make_unique<Workspace>(*this);
  }
  /// Does not allocate but for mixtures and Bayesian networks. Cost: 2 flops a number of the map.
  const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                        const Eigen::Ref<const Eigen::VectorXd>& known,
                        Estimator::Workspace& workspace) const override;
  Eigen::MatrixXd makeInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const override {
    return map_->inputs.apply(features, known);
  }
  void save(Hdf5Writer& file, const std::string& group) const override;

 private:
  void setMixture(const network::Predictor::Workspace& predicted, Estimate& estimate) const;

  std::shared_ptr<const NetworkMap> map_;
  linalg::PairedMatrix projection_;
  network::EnsemblePredictor predictor_;
};

/// Reads what save() wrote. Errors as of readNetworkMap().
std::shared_ptr<const Estimator> loadNetwork(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
