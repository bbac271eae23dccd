#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "framework/estimation/estimator.hpp"
#include "framework/estimation/gp/gp_map.hpp"
#include "kernels/gp/online/online_predictor.hpp"

namespace twinmap {

class Hdf5Reader;

/// An inverse map made ready for one measurement after another: the transform's steps become one, the
/// processes are packed. Estimates are those of the map to rounding. Immutable.
class OnlineProcesses final : public Estimator {
 public:
  explicit OnlineProcesses(GpMap map);

  const GpMap& getMap() const { return map_; }

  class Workspace final : public Estimator::Workspace {
   public:
    explicit Workspace(const OnlineProcesses& map);

   private:
    friend class OnlineProcesses;
    gp::OnlinePredictor::Workspace predictor;
    Eigen::VectorXd slope;
  };

  const char* getKind() const override { return "gp"; }
  Eigen::Index countFeatures() const override { return feature_count_; }
  Eigen::Index countKnown() const override { return map_.known_inputs.center.size(); }
  const Eigen::MatrixXd& getResidualCorrelation() const override { return map_.residual_correlation; }
  std::vector<Eigen::VectorXd> listLengthScales() const override;
  /// The transform's last projection.
  Eigen::MatrixXd getProjection() const override;
  std::unique_ptr<Estimator::Workspace> makeWorkspace() const override {
    return std::make_unique<Workspace>(*this);
  }
  /// It allocates nothing. Cost: 2 k d flops, then those of OnlinePredictor; some 10 us for four parameters.
  const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                        const Eigen::Ref<const Eigen::VectorXd>& known,
                        Estimator::Workspace& workspace) const override;
  /// The stddev is zero.
  const Estimate& inferMean(const Eigen::Ref<const Eigen::VectorXd>& features,
                            const Eigen::Ref<const Eigen::VectorXd>& known,
                            Estimator::Workspace& workspace) const override;
  Eigen::MatrixXd makeInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const override {
    return map_.makeProcessInputs(features, known);
  }
  void save(Hdf5Writer& file, const std::string& group) const override;

 private:
  void setInputs(const Eigen::Ref<const Eigen::VectorXd>& features,
                 const Eigen::Ref<const Eigen::VectorXd>& known, Eigen::VectorXd& inputs) const;
  double calcNoiseFactor(Eigen::Index parameter, const Eigen::Ref<const Eigen::VectorXd>& gradient,
                         Eigen::VectorXd& slope) const;

  GpMap map_;
  Eigen::Index feature_count_ = 0;
  Eigen::MatrixXd matrix_;  // inputs = matrix features + offset; one column: a factor for each feature
  Eigen::VectorXd offset_;
  Eigen::VectorXd noise_variance_;
  gp::OnlinePredictor predictor_;
};

/// The map with its exact processes compressed (gp::compress), where that makes them smaller: means within
/// some 0.01 standard deviations, standard deviations within 0.2 % of the exact ones.
GpMap compressMap(const GpMap& map);

/// Reads what save() wrote. Errors as of readGpMap().
std::shared_ptr<const Estimator> loadProcesses(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
