#include "framework/inverse_map/gp_map.hpp"

#include <map>
#include <stdexcept>

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

/// Groups of features that share a length scale, numbered from 0 without gaps; empty for one group.
std::vector<int> makeGroups(LengthScales length_scales, const std::vector<FeatureInfo>& infos) {
  std::vector<int> groups;
  if (length_scales == LengthScales::kShared) {
    return groups;
  }
  std::map<int, int> group_of_output;
  for (const FeatureInfo& info : infos) {
    const int next_output = static_cast<int>(group_of_output.size());
    const int output_group = group_of_output.emplace(info.output, next_output).first->second;
    const bool per_output = length_scales == LengthScales::kPerOutput;
    groups.push_back(per_output ? output_group : static_cast<int>(groups.size()));
  }
  return groups;
}

gp::RelativeBounds toKernel(const Bounds& bounds) {
  return {bounds.lower, bounds.upper};
}

gp::TrainingOptions toKernel(const GpMapSpec& spec, int threads) {
  gp::TrainingOptions options;
  options.starts = spec.starts;
  options.max_evaluations = spec.max_evaluations;
  options.length_scale = toKernel(spec.bounds.length_scale);
  options.signal_stddev = toKernel(spec.bounds.signal_stddev);
  options.noise_stddev = toKernel(spec.bounds.noise_stddev);
  options.threads = threads;
  return options;
}

Eigen::VectorXd calcStddev(const Eigen::MatrixXd& rows, const Eigen::VectorXd& mean) {
  const Eigen::MatrixXd centered = rows.colwise() - mean;
  return (centered.rowwise().squaredNorm() / (static_cast<double>(rows.cols()) - 1.0)).cwiseSqrt();
}

}  // namespace

Predictions GpMap::predict(const Eigen::MatrixXd& features) const {
  const Eigen::MatrixXd inputs = transform.apply(features);
  const auto parameters = static_cast<Eigen::Index>(processes.size());
  Predictions predictions{Eigen::MatrixXd(parameters, features.cols()),
                          Eigen::MatrixXd(parameters, features.cols())};
  for (Eigen::Index p = 0; p < parameters; ++p) {
    const gp::Prediction standardised = processes[p]->predict(inputs);
    predictions.mean.row(p) = target_offset[p] + target_scale[p] * standardised.mean.transpose().array();
    predictions.stddev.row(p) = target_scale[p] * standardised.stddev().transpose();
  }
  return predictions;
}

GpMapTraining trainGpMap(const GpMapSpec& spec, const std::vector<TransformStep>& transform,
                         const std::vector<FeatureInfo>& infos,
                         const std::vector<std::string>& parameter_names, const Eigen::MatrixXd& features,
                         const Eigen::MatrixXd& parameters, int threads) {
  GpMapTraining training;
  GpMap& map = training.map;
  map.transform = fitTransform(transform, features);
  map.target_offset = parameters.rowwise().mean();
  map.target_scale = calcStddev(parameters, map.target_offset);
  const Eigen::MatrixXd targets =
      (parameters.colwise() - map.target_offset).array().colwise() / map.target_scale.array();

  gp::ModelStructure structure;
  structure.covariance = toKernel(spec.covariance);
  structure.length_scale_groups = makeGroups(spec.length_scales, infos);
  structure.linear_term = spec.linear_term;
  structure.mean = toKernel(spec.mean);
  const std::vector<gp::TrainingResult> results =
      gp::train(map.transform.apply(features), targets, structure, toKernel(spec, threads));

  for (std::size_t p = 0; p < results.size(); ++p) {
    if (results[p].gp == nullptr) {
      throw std::runtime_error("the map of parameter '" + parameter_names[p] +
                               "' cannot be trained: " + results[p].message);
    }
    map.processes.push_back(results[p].gp);
    if (results[p].status != gp::TrainingStatus::kConverged) {
      training.warnings.push_back("parameter '" + parameter_names[p] + "': " + results[p].message);
    }
  }
  return training;
}

}  // namespace twinmap
