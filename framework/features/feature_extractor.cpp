#include "framework/features/feature_extractor.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace twinmap {
namespace {

std::string makeName(const std::string& output, double time) {
  char text[32];
  std::snprintf(text, sizeof(text), "(%.6g s)", time);
  return output + text;
}

Eigen::Index findIndex(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument("feature of an unknown output '" + name + "'");
  }
  return found - names.begin();
}

Eigen::Index findTime(const Eigen::VectorXd& times, double time) {
  const double* found = std::lower_bound(times.data(), times.data() + times.size(), time);
  if (found == times.data() + times.size() || *found != time) {
    throw std::invalid_argument("feature at a time that the responses lack");
  }
  return found - times.data();
}

}  // namespace

Eigen::VectorXd collectTimes(const std::vector<FeatureSpec>& features) {
  std::vector<double> times;
  for (const FeatureSpec& feature : features) {
    for (int i = 0; i < feature.samples->count; ++i) {
      times.push_back(calcSampleTime(*feature.samples, i));
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return Eigen::Map<Eigen::VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
}

FeatureExtractor::FeatureExtractor(const std::vector<FeatureSpec>& features,
                                   const std::vector<std::string>& output_names,
                                   const Eigen::VectorXd& times) {
  for (const FeatureSpec& feature : features) {
    for (const Name& output : feature.samples->outputs) {
      const Eigen::Index index = findIndex(output_names, output.text);
      for (int i = 0; i < feature.samples->count; ++i) {
        const double time = calcSampleTime(*feature.samples, i);
        infos_.push_back({makeName(output.text, time), static_cast<int>(index), time});
        rows_.push_back(index * times.size() + findTime(times, time));
      }
    }
  }
}

Eigen::MatrixXd FeatureExtractor::extract(const Eigen::MatrixXd& responses) const {
  return responses(rows_, Eigen::all);
}

}  // namespace twinmap
