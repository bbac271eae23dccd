#include "framework/estimation/gp/online_processes.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "framework/base/hdf5/hdf5_fields.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"
#include "kernels/gp/sparse/compression.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

using ExactProcess = std::shared_ptr<const gp::GaussianProcess>;

enum class Approximation { kExact, kSgpr };
const std::initializer_list<const char*> kApproximations = {"exact", "sgpr"};

template <class Fields, class Parts>
void listModel(const Fields& fields, Parts& parts) {
  fields("length_scales", parts.hyperparameters.length_scales);
  fields.converted(
      "length_scale_groups", parts.structure.length_scale_groups,
      [](const std::vector<int>& groups) { return std::vector<std::int64_t>(groups.begin(), groups.end()); },
      [](const std::vector<std::int64_t>& read) { return std::vector<int>(read.begin(), read.end()); });
  fields("signal_stddev", parts.hyperparameters.signal_stddev);
  fields("noise_stddev", parts.hyperparameters.noise_stddev);
  fields("shape", parts.hyperparameters.shape);
  fields("linear_stddev", parts.hyperparameters.linear_stddev);
  fields.choice("covariance", parts.structure.covariance,
                {"squared_exponential", "matern32", "matern52", "rational_quadratic"});
  fields.choice("mean", parts.structure.mean, {"zero", "constant", "linear"});
  fields.choice("linear_term", parts.structure.linear_term, {"false", "true"});
}

template <class Fields, class Parts>
void listExact(const Fields& fields, Parts& parts) {
  listModel(fields, parts);
  fields("mean_coefficients", parts.mean_coefficients);
  fields("alpha", parts.alpha);
  fields.transposed("factor", parts.factor);
  fields("nlml", parts.nlml);
  fields("jitter", parts.jitter);
}

template <class Fields, class Parts>
void listSparse(const Fields& fields, Parts& parts) {
  auto& posterior = parts.posterior;
  listModel(fields, parts);
  fields("center", parts.center);
  fields("inducing", parts.inducing);
  fields.transposed("inducing_factor", posterior.inducing_factor);
  fields.transposed("correction_factor", posterior.correction_factor);
  fields("weights", posterior.weights);
  fields.transposed("whitened_basis", posterior.whitened_basis);
  fields.transposed("basis_factor", posterior.basis_factor);
  fields("mean_coefficients", posterior.mean_coefficients);
  fields("bound", posterior.bound);
  fields("jitter", posterior.jitter);
}

using TrainingInputs = std::shared_ptr<const Eigen::MatrixXd>;  // which exact processes share

void listProcess(const WrittenFields& fields, const gp::Process& process, const TrainingInputs&) {
  if (const auto* exact = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&process)) {
    listExact(fields, (*exact)->getParts());
    fields.choice("approximation", Approximation::kExact, kApproximations);
  } else {
    listSparse(fields, std::get<std::shared_ptr<const gp::SparseGaussianProcess>>(process)->getParts());
    fields.choice("approximation", Approximation::kSgpr, kApproximations);
  }
}

void listProcess(const ReadFields& fields, gp::Process& process, const TrainingInputs& inputs) {
  Approximation approximation = Approximation::kExact;
  fields.choice("approximation", approximation, kApproximations);
  if (approximation == Approximation::kExact) {
    gp::GaussianProcessParts parts;
    parts.inputs = inputs;
    listExact(fields, parts);
    process = std::make_shared<const gp::GaussianProcess>(std::move(parts));
  } else {
    gp::SparseGaussianProcessParts parts;
    listSparse(fields, parts);
    process = std::make_shared<const gp::SparseGaussianProcess>(std::move(parts));
  }
}

template <class Fields, class Map>
void listMap(const Fields& fields, Map& map, TrainingInputs inputs) {
  fields.each("transform/steps", "transform", map.transform.steps, [](const Fields& of_step, auto& step) {
    of_step("offset", step.offset);
    of_step("scale", step.scale);
    of_step.transposed("projection", step.projection);
  });
  fields("known_inputs/center", map.known_inputs.center);
  fields("known_inputs/half_width", map.known_inputs.half_width);
  fields("target/offset", map.target_offset);
  fields("target/scale", map.target_scale);
  fields("residual_correlation", map.residual_correlation);
  fields("noise/directions", map.noise.directions);
  fields("noise/mean_of_slope", map.noise.mean_of_slope);
  if (fields.has("training_inputs", inputs != nullptr)) {
    fields.converted(
        "training_inputs", inputs, [](const TrainingInputs& matrix) { return Eigen::MatrixXd(*matrix); },
        [](Eigen::MatrixXd& read) { return std::make_shared<const Eigen::MatrixXd>(std::move(read)); });
  }
  fields.each("processes/count", "processes", map.processes,
              [&](const Fields& of_process, auto& process) { listProcess(of_process, process, inputs); });
}

/// Whether each step takes what the one before it gives; `count` becomes what the last one gives.
bool isChain(const FeatureTransform& transform, Eigen::Index& count) {
  bool fits = true;
  for (const AffineStep& step : transform.steps) {
    const Eigen::Index taken = step.offset.size();
    fits = fits && taken > 0 && step.scale.size() == taken && (count < 0 || taken == count) &&
           (step.projection.size() == 0 || step.projection.cols() == taken);
    count = step.projection.size() == 0 ? taken : step.projection.rows();
  }
  return fits && count >= 0;
}

bool fitsTogether(const GpMap& map) {
  const auto p = static_cast<Eigen::Index>(map.processes.size());
  const Eigen::Index known = map.known_inputs.center.size();
  Eigen::Index transformed = -1;
  bool fits = isChain(map.transform, transformed) && p > 0 && map.known_inputs.half_width.size() == known &&
              map.target_offset.size() == p && map.target_scale.size() == p &&
              map.residual_correlation.rows() == p && map.residual_correlation.cols() == p;
  for (const gp::Process& process : map.processes) {
    fits = fits &&
           std::visit([](const auto& one) { return one->getFeatureCount(); }, process) == transformed + known;
  }
  const NoiseProfile& noise = map.noise;
  return fits && (noise.isConstant() ||
                  (noise.directions.rows() <= transformed + known && noise.mean_of_slope.size() == p));
}

/// Null if all are sparse.
TrainingInputs findTrainingInputs(const GpMap& map) {
  for (const gp::Process& process : map.processes) {
    if (const auto* exact = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&process)) {
      return (*exact)->getParts().inputs;
    }
  }
  return nullptr;
}

/// Writes all that a map of processes consists of below `group` (docs/reference/files.md).
void writeGpMap(Hdf5Writer& file, const std::string& group, const GpMap& map) {
  listMap(WrittenFields(file, group), map, findTrainingInputs(map));
}

/// Reads it back; it predicts bit for bit as the one that was written. Throws std::runtime_error or
/// std::invalid_argument for parts that are missing or do not fit each other.
GpMap readGpMap(const Hdf5Reader& file, const std::string& group) {
  GpMap map;
  const ReadFields fields(file, group);
  listMap(fields, map, nullptr);
  fields.require(fitsTogether(map));
  return map;
}

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
