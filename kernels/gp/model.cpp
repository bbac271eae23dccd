#include "kernels/gp/model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace twinmap::gp {
namespace {

void requirePositive(double value, const std::string& name) {
  if (value > 0.0 && std::isfinite(value)) {
    return;
  }
  std::ostringstream message;
  message << "hyperparameter " << name << " is " << value << "; it must be positive and finite";
  throw std::invalid_argument(message.str());
}

}  // namespace

std::vector<int> oneGroupPerFeature(int feature_count) {
  std::vector<int> groups(feature_count);
  std::iota(groups.begin(), groups.end(), 0);
  return groups;
}

int getGroupCount(const ModelStructure& structure) {
  const auto& groups = structure.length_scale_groups;
  return groups.empty() ? 1 : 1 + *std::max_element(groups.begin(), groups.end());
}

int getMeanCoefficientCount(const ModelStructure& structure, Eigen::Index feature_count) {
  switch (structure.mean) {
    case MeanFunction::kZero:
      return 0;
    case MeanFunction::kConstant:
      return 1;
    case MeanFunction::kLinear:
      return 1 + static_cast<int>(feature_count);
  }
  return 0;
}

HyperparameterLayout::HyperparameterLayout(const ModelStructure& structure)
    : signal(getGroupCount(structure)), noise(signal + 1), shape(-1), linear(-1), count(noise + 1) {
  if (hasShape(structure.covariance)) {
    shape = count++;
  }
  if (structure.linear_term) {
    linear = count++;
  }
}

Eigen::VectorXd toLog(const ModelStructure& structure, const Hyperparameters& hyperparameters) {
  const HyperparameterLayout layout(structure);
  Eigen::VectorXd values(layout.count);
  values.head(layout.signal) = hyperparameters.length_scales;
  values(layout.signal) = hyperparameters.signal_stddev;
  values(layout.noise) = hyperparameters.noise_stddev;
  if (layout.shape >= 0) {
    values(layout.shape) = hyperparameters.shape;
  }
  if (layout.linear >= 0) {
    values(layout.linear) = hyperparameters.linear_stddev;
  }
  return values.unaryExpr([](double value) { return std::log(value); });
}

Hyperparameters fromLog(const ModelStructure& structure, const Eigen::VectorXd& log_hyperparameters) {
  const HyperparameterLayout layout(structure);
  const Eigen::VectorXd values = log_hyperparameters.unaryExpr([](double value) { return std::exp(value); });
  Hyperparameters hyperparameters;
  hyperparameters.length_scales = values.head(layout.signal);
  hyperparameters.signal_stddev = values(layout.signal);
  hyperparameters.noise_stddev = values(layout.noise);
  if (layout.shape >= 0) {
    hyperparameters.shape = values(layout.shape);
  }
  if (layout.linear >= 0) {
    hyperparameters.linear_stddev = values(layout.linear);
  }
  return hyperparameters;
}

std::vector<std::string> getHyperparameterNames(const ModelStructure& structure) {
  const HyperparameterLayout layout(structure);
  std::vector<std::string> names;
  for (int g = 0; g < layout.signal; ++g) {
    names.push_back("length_scale[" + std::to_string(g) + "]");
  }
  names.insert(names.end(), {"signal_stddev", "noise_stddev"});
  if (layout.shape >= 0) {
    names.push_back("shape");
  }
  if (layout.linear >= 0) {
    names.push_back("linear_stddev");
  }
  return names;
}

void checkStructure(const ModelStructure& structure, Eigen::Index feature_count) {
  const auto& groups = structure.length_scale_groups;
  if (groups.empty()) {
    return;
  }
  if (static_cast<Eigen::Index>(groups.size()) != feature_count) {
    throw std::invalid_argument("length_scale_groups has " + std::to_string(groups.size()) + " entries for " +
                                std::to_string(feature_count) + " features; it needs one per feature");
  }
  std::vector<bool> used(groups.size(), false);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i] < 0 || groups[i] >= static_cast<int>(groups.size())) {
      throw std::invalid_argument("length_scale_groups[" + std::to_string(i) + "] is " +
                                  std::to_string(groups[i]) + "; groups count from 0 without gaps");
    }
    used[groups[i]] = true;
  }
  for (int g = 0; g < getGroupCount(structure); ++g) {
    if (!used[g]) {
      throw std::invalid_argument("length_scale_groups never uses group " + std::to_string(g) +
                                  "; groups count from 0 without gaps");
    }
  }
}

void checkHyperparameters(const ModelStructure& structure, const Hyperparameters& hyperparameters) {
  const Eigen::Index groups = getGroupCount(structure);
  if (hyperparameters.length_scales.size() != groups) {
    throw std::invalid_argument("hyperparameters have " +
                                std::to_string(hyperparameters.length_scales.size()) +
                                " length scales; the structure has " + std::to_string(groups) + " groups");
  }
  for (Eigen::Index g = 0; g < groups; ++g) {
    requirePositive(hyperparameters.length_scales(g), "length_scale[" + std::to_string(g) + "]");
  }
  requirePositive(hyperparameters.signal_stddev, "signal_stddev");
  requirePositive(hyperparameters.noise_stddev, "noise_stddev");
  if (hasShape(structure.covariance)) {
    requirePositive(hyperparameters.shape, "shape");
  }
  if (structure.linear_term) {
    requirePositive(hyperparameters.linear_stddev, "linear_stddev");
  }
}

void checkInputs(const Eigen::Ref<const Eigen::MatrixXd>& inputs, const char* caller) {
  for (Eigen::Index sample = 0; sample < inputs.cols(); ++sample) {
    for (Eigen::Index feature = 0; feature < inputs.rows(); ++feature) {
      if (std::isfinite(inputs(feature, sample))) {
        continue;
      }
      std::ostringstream message;
      message << caller << ": row " << feature << " of sample " << sample << " is " << inputs(feature, sample)
              << "; every value must be finite";
      throw std::invalid_argument(message.str());
    }
  }
}

}  // namespace twinmap::gp
