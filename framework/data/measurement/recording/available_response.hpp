#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/experiment/measurement_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// A sample at a limit of its sensor's range: the response is there or beyond.
struct ClippedSample {
  Eigen::Index row = 0;  ///< of the layout, or a feature
  double limit = 0.0;
  double side = 1.0;  ///< 1: the upper limit, -1: the lower
};

/// A measured response of which some samples may be missing.
struct AvailableResponse {
  Eigen::VectorXd response;  ///< rows of the layout; NaN where missing or clipped
  std::vector<ClippedSample> clipped;
  Eigen::Index missing = 0;          ///< rows
  std::vector<std::string> remarks;  ///< what is missing and why, a phrase each; rows that were put in order
  Eigen::VectorXd stddev{};  ///< of rows, where the measurement states it; NaN of others; empty: of none
};

/// Only the modes, from the table that `spec.modes` names, beside the measurement; all else missing.
AvailableResponse readModesBeside(const Table& table, const MeasurementSpec& spec,
                                  const ResponseLayout& layout);

/// The outputs of a layout at its times, `start` (s) being the time of the measurement that is the model's 0,
/// from a table in which cells may be NaN, rows lost, out of order or doubled, and each column may have a
/// rate of its own, or a file and a clock of its own; such files are read here. Rows without a time are left
/// out, the others sorted by it, the first of several with the same time kept. A needed sample is there where
/// the column has one within 1e-6 of its median step; else it is interpolated (cubic through the four nearest
/// samples) where the column's median step is at most `interval`, the smallest at which features sample the
/// outputs (default: that of the layout's times), and no step about it is longer than 1.5 median steps; else
/// it is missing. Where the measurement states a range, a sample at one of its limits (within 1e-6 of the
/// range) is clipped, and one that would be interpolated between two that are; one beside such a sample is
/// missing. Modes are read from a table of their own (readModes), or from the table itself where the layout
/// has no times. Throws MeasurementError for an output without any needed sample and one that is the same at
/// all of them (a dead sensor).
/// features: what the samples are for. Outputs of none are not read; where all are samples, an output's
/// samples are missing only at times at which one of them asks for it. Empty: all are needed.
AvailableResponse readAvailable(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
                                double start, std::optional<double> interval = {},
                                const std::vector<FeatureSpec>& features = {});

}  // namespace twinmap
