#include "framework/estimation/gp/train_gp_map.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <numeric>
#include <stdexcept>

#include "framework/estimation/gp/predict_left_out.hpp"
#include "kernels/gp/fit.hpp"
#include "kernels/gp/sparse/sparse_training.hpp"
#include "kernels/gp/training_set.hpp"

namespace twinmap {
namespace {

gp::CovarianceFunction toKernel(GpCovariance covariance) {
  switch (covariance) {
    case GpCovariance::kMatern32:
      return gp::CovarianceFunction::kMatern32;
    case GpCovariance::kMatern52:
      return gp::CovarianceFunction::kMatern52;
    case GpCovariance::kRationalQuadratic:
      return gp::CovarianceFunction::kRationalQuadratic;
    case GpCovariance::kSquaredExponential:
      break;
  }
  return gp::CovarianceFunction::kSquaredExponential;
}

gp::MeanFunction toKernel(GpMean mean) {
  switch (mean) {
    case GpMean::kZero:
      return gp::MeanFunction::kZero;
    case GpMean::kLinear:
      return gp::MeanFunction::kLinear;
    case GpMean::kConstant:
      break;
  }
  return gp::MeanFunction::kConstant;
}

/// Groups of features that share a length scale, numbered from 0 without gaps; empty for one group. Without a
/// projection, inputs are features.
std::vector<int> makeGroups(LengthScales length_scales, const std::vector<FeatureInfo>& infos, int inputs) {
  std::vector<int> groups;
  if (length_scales == LengthScales::kPerFeature) {
    groups.resize(inputs);
    std::iota(groups.begin(), groups.end(), 0);
  } else if (length_scales == LengthScales::kPerOutput) {
    std::map<int, int> group_of_output;
    for (const FeatureInfo& info : infos) {
      const int next = static_cast<int>(group_of_output.size());
      groups.push_back(group_of_output.emplace(info.output, next).first->second);
    }
  }
  return groups;
}

/// The same with known inputs behind the features, each with a length scale of its own.
std::vector<int> addKnownInputs(std::vector<int> groups, int features, int known) {
  if (known > 0 && groups.empty()) {
    groups.assign(features, 0);
  }
  const int first = groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
  for (int i = 0; i < known; ++i) {
    groups.push_back(first + i);
  }
  return groups;
}

gp::RelativeBounds toKernel(const Bounds& bounds) {
  return {bounds.lower, bounds.upper};
}

/// What an experiment says of its maps, in the kernels' terms.
gp::TrainingOptions makeTrainingOptions(const GpMapSpec& spec, const TrainingControl& control) {
  gp::TrainingOptions options;
  options.starts = spec.starts;
  options.max_evaluations = spec.max_evaluations;
  options.length_scale = toKernel(spec.bounds.length_scale);
  options.signal_stddev = toKernel(spec.bounds.signal_stddev);
  options.noise_stddev = toKernel(spec.bounds.noise_stddev);
  if (spec.length_scale_prior) {
    options.length_scale_prior = {spec.length_scale_prior->log_mean, spec.length_scale_prior->log_stddev};
  }
  options.threads = control.threads;
  options.stop = control.stop;
  return options;
}

/// The structure of processes with `inputs` inputs, the last `known` of them known inputs, which have a
/// length scale each. `infos`: of the features before the transform; length scales per output are for
/// transforms that keep the features.
gp::ModelStructure makeStructure(const GpMapSpec& spec, const std::vector<FeatureInfo>& infos, int inputs,
                                 int known) {
  gp::ModelStructure structure;
  structure.covariance = toKernel(spec.covariance);
  structure.length_scale_groups =
      addKnownInputs(makeGroups(spec.length_scales, infos, inputs - known), inputs - known, known);
  structure.linear_term = spec.linear_term;
  structure.mean = toKernel(spec.mean);
  return structure;
}

const gp::TrainingReport& getReport(const gp::TrainingResult& result) {
  return result.report;
}
const gp::TrainingReport& getReport(const gp::SparseTrainingResult& result) {
  return result.subset_report;
}

std::string dropDigits(std::string text) {
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  text.erase(std::remove_if(text.begin(), text.end(), is_digit), text.end());
  return text;
}

/// Adds what is to be told of a parameter, with the names of others of which the same was told but for
/// numbers: "parameter 'k', 'd': the best start ...".
void addWarning(const std::string& parameter, const std::string& message,
                std::vector<std::string>& warnings) {
  const std::string kind = ": " + dropDigits(message);
  for (std::string& warning : warnings) {
    const std::string told = dropDigits(warning);
    if (told.size() > kind.size() && told.compare(told.size() - kind.size(), kind.size(), kind) == 0) {
      warning.insert(warning.find(": "), ", '" + parameter + "'");
      return;
    }
  }
  warnings.push_back("parameter '" + parameter + "': " + message);
}

/// Keeps the processes of training results and what a person should know about them.
template <class Result>
void keepResults(const std::vector<Result>& results, const std::vector<std::string>& parameter_names,
                 GpMapTraining& training) {
  for (std::size_t p = 0; p < results.size(); ++p) {
    if (results[p].gp == nullptr) {
      throw std::runtime_error("the map of parameter '" + parameter_names[p] +
                               "' cannot be trained: " + results[p].message);
    }
    training.map.processes.emplace_back(results[p].gp);
    training.reports.push_back(getReport(results[p]));
    if (results[p].status != gp::TrainingStatus::kConverged) {
      addWarning(parameter_names[p], results[p].message, training.warnings);
    }
  }
}

/// Where the search for each target begins: what is found on the first of the replicates, with the curvature
/// that all of them give. Nothing if a target cannot be trained.
std::vector<gp::WarmStart> findWarmStarts(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& targets,
                                          int replicates, const gp::ModelStructure& structure,
                                          gp::TrainingOptions options) {
  constexpr double kTolerance = 1e-2;  // nats: the whole set's optimum lies further away than that
  options.tolerance = kTolerance;
  options.curvature = true;
  const Eigen::Index first = inputs.cols() / replicates;
  std::vector<gp::WarmStart> found;
  for (const gp::TrainingResult& result :
       gp::train(inputs.leftCols(first), targets.leftCols(first), structure, options)) {
    if (result.gp == nullptr) {
      return {};
    }
    found.push_back({result.gp->getHyperparameters(), replicates * result.curvature});
  }
  return found;
}

using SparseProcess = std::shared_ptr<const gp::SparseGaussianProcess>;

gp::Process refitSparse(const gp::SparseGaussianProcessParts& trained, const Eigen::MatrixXd& inputs,
                        const Eigen::VectorXd& target, const gp::ModelStructure& structure) {
  gp::SparseGaussianProcessParts parts{
      structure, trained.hyperparameters, gp::calcCenter(inputs), trained.inducing, {}};
  const gp::VariationalBound bound(inputs, target, parts.inducing, structure);
  if (!bound.calcPosterior(parts.hyperparameters, parts.posterior)) {
    throw std::runtime_error("the inducing inputs' covariance is not positive definite");
  }
  return std::make_shared<const gp::SparseGaussianProcess>(std::move(parts));
}

/// An exact process, which may be stored compressed, has its hyperparameters alone; a sparse one its inducing
/// inputs, too.
gp::Process refit(GpApproximation approximation, const gp::Process& trained, const Eigen::MatrixXd& inputs,
                  const Eigen::VectorXd& target, const gp::ModelStructure& structure, int threads) {
  if (approximation == GpApproximation::kSgpr) {
    const auto* sparse = std::get_if<SparseProcess>(&trained);
    if (sparse == nullptr) {
      throw std::runtime_error("the trained processes are not sparse");
    }
    return refitSparse((*sparse)->getParts(), inputs, target, structure);
  }
  const gp::Hyperparameters hyperparameters =
      std::visit([](const auto& process) { return process->getHyperparameters(); }, trained);
  return gp::fit(inputs, target, structure, hyperparameters, threads);
}

Eigen::VectorXd calcStddev(const Eigen::MatrixXd& rows, const Eigen::VectorXd& mean) {
  const Eigen::MatrixXd centered = rows.colwise() - mean;
  return (centered.rowwise().squaredNorm() / (static_cast<double>(rows.cols()) - 1.0)).cwiseSqrt();
}

/// What the processes are trained on.
struct TrainingData {
  Eigen::MatrixXd inputs;   // k + q x n, of the processes
  Eigen::MatrixXd targets;  // p x n, standardised parameters
};

/// Fits transform, offset and scale of the map.
TrainingData prepare(const std::vector<TransformStepSpec>& transform, const LabelledFeatures& samples,
                     const std::vector<ParameterSpec>& known_inputs, GpMap& map) {
  map.known_inputs = makeKnownInputs(known_inputs);
  map.transform = fitTransform(transform, samples);
  map.target_offset = samples.parameters.rowwise().mean();
  map.target_scale = calcStddev(samples.parameters, map.target_offset);
  return {map.makeProcessInputs(samples.features, samples.inputs),
          (samples.parameters.colwise() - map.target_offset).array().colwise() / map.target_scale.array()};
}

/// Fits the processes found on the first columns to all of them; a process that cannot be is null.
void fitToAll(const TrainingData& data, const gp::ModelStructure& structure, const TrainingControl& control,
              std::vector<gp::TrainingResult>& results) {
  for (std::size_t p = 0; p < results.size(); ++p) {
    if (results[p].gp == nullptr) {
      continue;
    }
    gp::throwIfStopped(control.stop);
    const gp::Hyperparameters found = results[p].gp->getHyperparameters();
    try {
      results[p].gp = gp::fit(data.inputs, data.targets.row(static_cast<Eigen::Index>(p)).transpose(),
                              structure, found, control.threads);
    } catch (const std::runtime_error& error) {
      results[p].gp = nullptr;
      results[p].message = error.what();
    }
  }
}

/// Searches the hyperparameters on the first columns, and fits the processes to all.
std::vector<gp::TrainingResult> trainExact(const TrainingData& data, Eigen::Index searched,
                                           const gp::ModelStructure& structure,
                                           const gp::TrainingOptions& options) {
  std::vector<gp::TrainingResult> results =
      gp::train(data.inputs.leftCols(searched), data.targets.leftCols(searched), structure, options);
  if (searched < data.inputs.cols()) {
    fitToAll(data, structure, {options.threads, options.stop}, results);
  }
  return results;
}

/// What follows from the trained processes: the noise's profile, and the training samples left out.
void finish(const GpMapSpec& spec, const TrainingData& data, const LabelledFeatures& samples,
            const TrainingControl& control, GpMapTraining& training) {
  GpMap& map = training.map;
  if (spec.noise == GpNoise::kFollowsSlope) {
    map.noise =
        fitNoiseProfile(map.processes, map.transform.applyToCovariance(samples.noise_covariance).toMatrix(),
                        data.inputs.leftCols(data.inputs.cols() / samples.replicates));
  }
  training.leave_one_out =
      predictLeftOut(training.map, data.inputs, data.targets, samples.replicates, control);
  training.map.residual_correlation = calcResidualCorrelation(
      (training.leave_one_out.mean - samples.parameters).cwiseQuotient(training.leave_one_out.stddev));
}

}  // namespace

int countSearchedReplicates(Eigen::Index columns, int replicates) {
  constexpr Eigen::Index kMaxColumns = 2000;
  const Eigen::Index samples = columns / replicates;
  return static_cast<int>(std::clamp<Eigen::Index>(kMaxColumns / samples, 1, replicates));
}

GpMapTraining trainGpMap(const GpMapSpec& spec, const std::vector<TransformStepSpec>& transform,
                         const std::vector<std::string>& parameter_names, const LabelledFeatures& samples,
                         const TrainingControl& control, const std::vector<ParameterSpec>& known_inputs) {
  GpMapTraining training;
  const TrainingData data = prepare(transform, samples, known_inputs, training.map);
  const gp::ModelStructure structure = makeStructure(
      spec, samples.infos, static_cast<int>(data.inputs.rows()), static_cast<int>(known_inputs.size()));
  gp::TrainingOptions options = makeTrainingOptions(spec, control);
  const bool sparse_map = spec.approximation == GpApproximation::kSgpr;
  const int draws =
      sparse_map ? samples.replicates : countSearchedReplicates(data.inputs.cols(), samples.replicates);
  if (draws > 1) {
    options.warm_starts = findWarmStarts(data.inputs, data.targets, samples.replicates, structure, options);
  }
  if (sparse_map) {
    const gp::SparseOptions sparse{spec.inducing, spec.subset, spec.refine_evaluations};
    keepResults(gp::trainSparse(data.inputs, data.targets, structure, options, sparse), parameter_names,
                training);
  } else {
    const Eigen::Index searched = data.inputs.cols() / samples.replicates * draws;
    keepResults(trainExact(data, searched, structure, options), parameter_names, training);
  }
  finish(spec, data, samples, control, training);
  return training;
}

GpMapTraining refitGpMap(const GpMap& trained, const GpMapSpec& spec,
                         const std::vector<TransformStepSpec>& transform, const LabelledFeatures& samples,
                         int threads, const std::vector<ParameterSpec>& known_inputs) {
  GpMapTraining training;
  const TrainingData data = prepare(transform, samples, known_inputs, training.map);
  const gp::ModelStructure structure = makeStructure(
      spec, samples.infos, static_cast<int>(data.inputs.rows()), static_cast<int>(known_inputs.size()));
  for (Eigen::Index p = 0; p < data.targets.rows(); ++p) {
    const Eigen::VectorXd target = data.targets.row(p).transpose();
    training.map.processes.push_back(
        refit(spec.approximation, trained.processes.at(p), data.inputs, target, structure, threads));
  }
  finish(spec, data, samples, {threads}, training);
  return training;
}

}  // namespace twinmap
