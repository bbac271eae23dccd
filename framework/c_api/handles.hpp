#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "framework/c_api/twinmap.h"
#include "framework/inference/measurement/inference_source.hpp"

namespace twinmap::c_api {

/// Where a number is not known.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace twinmap::c_api

/// What twinmap_map stands for.
struct twinmap_map {
  explicit twinmap_map(const std::filesystem::path& run_or_experiment);

  twinmap::InferenceSource source;
};

/// What twinmap_inferrer stands for.
struct twinmap_inferrer {
  twinmap_inferrer(const twinmap::InferenceSource& by, const twinmap::SessionOptions& options)
      : source(by), session(by.makeSession(options)) {}

  /// What the last inference left.
  struct Inferred {
    twinmap::InferredMeasurement measurement;
    twinmap::Estimate estimate;
  };

  /// Columns whose values come one by one.
  struct Pushed {
    std::vector<std::string> names;
    std::vector<std::vector<double>> values;
  };

  const twinmap::InferenceSource& source;
  const std::unique_ptr<twinmap::MeasurementInference> session;
  std::optional<double> start;
  std::optional<Eigen::VectorXd> known;
  Pushed pushed;
  std::optional<Inferred> inferred;
  std::string json;
};
