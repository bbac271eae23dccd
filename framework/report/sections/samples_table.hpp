#pragma once

#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/report/data_table.hpp"
#include "framework/report/figure.hpp"
#include "framework/results/run_folder.hpp"

namespace twinmap {

/// Columns of the table of test samples, per parameter.
inline std::string getTrueColumn(const std::string& parameter) {
  return "true_" + parameter;
}
inline std::string getInferredColumn(const std::string& parameter) {
  return "inferred_" + parameter;
}
inline std::string getStddevColumn(const std::string& parameter) {
  return "stddev_" + parameter;
}
inline std::string getLimitColumn(const std::string& parameter) {
  return "limit_stddev_" + parameter;
}
inline std::string getErrorColumn(const std::string& parameter) {
  return "error_" + parameter;
}
inline std::string getScoreColumn(const std::string& parameter) {
  return "z_" + parameter;
}
inline std::string getPitColumn(const std::string& parameter) {
  return "pit_" + parameter;
}

/// What predictions.csv says of one parameter, in the order of its samples.
struct ParameterPredictions {
  std::vector<double> samples, truth, inferred, stddev;
  std::vector<double> z;             ///< (inferred - true) / stddev; of mixtures, a normal number likewise
  std::vector<double> limit_stddev;  ///< empty if not known
};
ParameterPredictions collectPredictions(const RunFolder& run, const std::string& parameter);

/// The probability integral transform of z: the standard normal distribution function.
double calcPit(double z);

/// More test samples than these are not drawn: the first ones stand for all.
inline constexpr std::size_t kMaxDrawnSamples = 1000;

/// One row per test sample: its index, and per parameter the true and the inferred value, the stddev, the
/// limit where it is known, the error (inferred - true), z and its PIT.
DataTable makeSamplesTable(const RunFolder& run);

/// "The first 1000 of 5000 test samples are drawn.", or "".
std::string describeDrawnSamples(const RunFolder& run);

/// A choice among the parameters, whose domain is their bounds.
Choice makeParameterChoice(const std::string& name, const std::string& label,
                           const std::vector<ParameterSpec>& parameters, std::size_t chosen);

/// The domains of the axes "{x}" and "{y}" that the reader chooses, for the slots x_domain and y_domain.
std::map<std::string, SlotValue> makeChosenDomains();

}  // namespace twinmap
