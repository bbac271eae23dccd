#include "framework/estimation/gp/online_processes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/estimation/gp/gp_file.hpp"
#include "kernels/gp/sparse/compression.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

using ExactProcess = std::shared_ptr<const gp::GaussianProcess>;

}  // namespace

OnlineProcesses::OnlineProcesses(GpMap map) : map_(std::move(map)), predictor_(map_.processes) {
  feature_count_ = map_.transform.steps.front().offset.size();
  offset_ = map_.transform.apply(VectorXd::Zero(feature_count_));
  matrix_ = map_.transform.isDiagonal() ? MatrixXd(map_.transform.calcScale()) : map_.transform.calcMatrix();
  noise_variance_.resize(static_cast<Index>(map_.processes.size()));
  for (Index p = 0; p < noise_variance_.size(); ++p) {
    noise_variance_[p] = gp::getNoiseVariance(map_.processes[p]);
  }
}

OnlineProcesses::Workspace::Workspace(const OnlineProcesses& map) : predictor(map.predictor_) {
  const auto parameters = static_cast<Index>(map.map_.processes.size());
  estimate.estimator = map.getKind();
  estimate.correlation = map.map_.residual_correlation;
  estimate.mean.setZero(parameters);
  estimate.stddev.setZero(parameters);
  estimate.inputs.setZero(map.matrix_.rows() + map.map_.known_inputs.center.size());
  slope.setZero(map.map_.noise.directions.cols());
}

void OnlineProcesses::setInputs(const Eigen::Ref<const VectorXd>& features,
                                const Eigen::Ref<const VectorXd>& known, VectorXd& inputs) const {
  auto transformed = inputs.head(offset_.size());
  transformed = offset_;
  if (matrix_.cols() == 1 && feature_count_ > 1) {
    transformed += matrix_.col(0).cwiseProduct(features);
  } else {
    transformed.noalias() += matrix_ * features;
  }
  inputs.tail(known.size()) = (known - map_.known_inputs.center).cwiseQuotient(map_.known_inputs.half_width);
}

const Estimate& OnlineProcesses::infer(const Eigen::Ref<const VectorXd>& features,
                                       const Eigen::Ref<const VectorXd>& known,
                                       Estimator::Workspace& buffers) const {
  auto& workspace = static_cast<Workspace&>(buffers);
  Estimate& estimate = workspace.estimate;
  setInputs(features, known, estimate.inputs);
  if (map_.noise.isConstant()) {
    predictor_.predict(estimate.inputs, workspace.predictor);
  } else {
    predictor_.predictWithGradient(estimate.inputs, workspace.predictor);
  }
  const gp::OnlinePredictor::Values& values = workspace.predictor.values;
  estimate.mean = map_.target_offset + map_.target_scale.cwiseProduct(values.mean);
  for (Index p = 0; p < estimate.stddev.size(); ++p) {
    const double factor = calcNoiseFactor(p, values.gradient.col(p), workspace.slope);
    estimate.stddev[p] =
        map_.target_scale[p] * std::sqrt(values.latent_variance[p] + noise_variance_[p] * factor);
  }
  return estimate;
}

const Estimate& OnlineProcesses::inferMean(const Eigen::Ref<const VectorXd>& features,
                                           const Eigen::Ref<const VectorXd>& known,
                                           Estimator::Workspace& buffers) const {
  auto& workspace = static_cast<Workspace&>(buffers);
  Estimate& estimate = workspace.estimate;
  setInputs(features, known, estimate.inputs);
  predictor_.predictMean(estimate.inputs, workspace.predictor);
  estimate.mean = map_.target_offset + map_.target_scale.cwiseProduct(workspace.predictor.values.mean);
  estimate.stddev.setZero();
  return estimate;
}

double OnlineProcesses::calcNoiseFactor(Index parameter, const Eigen::Ref<const VectorXd>& gradient,
                                        VectorXd& slope) const {
  const NoiseProfile& noise = map_.noise;
  if (noise.isConstant() || !(noise.mean_of_slope[parameter] > 0.0)) {
    return 1.0;
  }
  slope.noalias() = noise.directions.transpose() * gradient.head(noise.directions.rows());
  return std::max(slope.squaredNorm() / noise.mean_of_slope[parameter], NoiseProfile::kSmallestFactor);
}

std::vector<VectorXd> OnlineProcesses::listLengthScales() const {
  std::vector<VectorXd> scales;
  for (const gp::Process& process : map_.processes) {
    scales.push_back(
        std::visit([](const auto& kind) { return kind->getHyperparameters().length_scales; }, process));
  }
  return scales;
}

MatrixXd OnlineProcesses::getProjection() const {
  MatrixXd projection;
  for (const AffineStep& step : map_.transform.steps) {
    projection = step.projection.size() > 0 ? step.projection : projection;
  }
  return projection;
}

void OnlineProcesses::save(Hdf5Writer& file, const std::string& group) const {
  writeGpMap(file, group, map_);
}

std::shared_ptr<const Estimator> loadProcesses(const Hdf5Reader& file, const std::string& group) {
  return std::make_shared<const OnlineProcesses>(readGpMap(file, group));
}

GpMap compressMap(const GpMap& map) {
  constexpr double kTolerance = 1e-4;
  GpMap compact = map;
  for (gp::Process& process : compact.processes) {
    if (const auto* exact = std::get_if<ExactProcess>(&process)) {
      if (const auto sparse = gp::compress(**exact, kTolerance)) {
        process = sparse;
      }
    }
  }
  return compact;
}

}  // namespace twinmap
