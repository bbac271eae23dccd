#include "framework/estimation/gp/gp_file.hpp"

#include <memory>
#include <variant>

#include "framework/base/hdf5/hdf5_fields.hpp"

namespace twinmap {
namespace {

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

}  // namespace

void writeGpMap(Hdf5Writer& file, const std::string& group, const GpMap& map) {
  listMap(WrittenFields(file, group), map, findTrainingInputs(map));
}

GpMap readGpMap(const Hdf5Reader& file, const std::string& group) {
  GpMap map;
  const ReadFields fields(file, group);
  listMap(fields, map, nullptr);
  fields.require(fitsTogether(map));
  return map;
}

}  // namespace twinmap
