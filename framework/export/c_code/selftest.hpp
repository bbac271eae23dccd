#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/export/c_code/c_source.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// A measurement and what twinmap infers of it.
struct TestedMeasurement {
  Eigen::VectorXd times;     ///< s
  Eigen::MatrixXd values;    ///< times x signals; of a map that takes features alone these, d x 1
  Eigen::VectorXd known;     ///< q
  Eigen::VectorXd features;  ///< d
  InferredMeasurement inferred;
};

/// What measurements are made.
struct TestPlan {
  int count = 50;
  CNumber number = CNumber::kDouble;  ///< what values are rounded to before the inference
  /// Some are a disturbance that lasts a while, a response beyond all that was simulated, times beside the
  /// grid.
  bool disturbed = true;
};

/// The run's test samples with noise, and what the model makes of them; those disturbed leave out
/// measurements whose estimate hangs on rounding. Throws ExperimentError for a run without samples.h5 or with
/// too few test samples.
std::vector<TestedMeasurement> makeTestedMeasurements(const std::filesystem::path& run,
                                                      const ExportedModel& model, const TestPlan& plan);

/// selftest.c
std::string makeSelftest(const ExportedModel& model, const COptions& options,
                         const std::vector<TestedMeasurement>& measurements);

}  // namespace twinmap
