#include "framework/estimation/gp/kernel_options.hpp"

#include <algorithm>
#include <map>
#include <numeric>

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

}  // namespace

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

}  // namespace twinmap
