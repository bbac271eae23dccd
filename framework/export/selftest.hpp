#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/export/c_source.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// A measurement and twinmap's answer.
struct TestedMeasurement {
  Eigen::VectorXd times;   ///< s
  Eigen::MatrixXd values;  ///< times x signals; of a map that takes features alone these, d x 1
  Eigen::VectorXd known;   ///< q
  InferredMeasurement answer;
};

/// The run's test samples with noise, `count` of them, most as a machine would give them, the others spoilt:
/// a disturbance that lasts a while, responses beyond all that was simulated, times beside the grid.
/// `number`: what values are rounded to before the answer is computed. Throws ExperimentError for a run
/// without samples.h5 or with too few test samples.
std::vector<TestedMeasurement> makeTestedMeasurements(const std::filesystem::path& run,
                                                      const Inferrer& inferrer, int count, CNumber number);

/// selftest.c
std::string makeSelftest(const ExportedModel& model, const COptions& options,
                         const std::vector<TestedMeasurement>& measurements);

}  // namespace twinmap
