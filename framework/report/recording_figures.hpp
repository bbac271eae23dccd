#pragma once

#include <Eigen/Core>
#include <string>

#include "framework/report/figure.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// A recording beside the model that was fitted to it: rows of the layout each, NaN where there is none.
struct ShownRecording {
  std::string id;  ///< letters, digits and '-': that of its figures begins with it
  ResponseLayout layout;
  Eigen::VectorXd measured, noise_stddev;
  Eigen::VectorXd updated;           ///< of the fitted model
  Eigen::VectorXd nominal{};         ///< of the model at the centre of the bounds, or empty
  Eigen::VectorXd lower{}, upper{};  ///< band of the fitted model, or empty
  std::string all_times{};           ///< where all times are found, if the figures leave some out; or ""
};

/// For each output, measured over fitted with the residual below, and the residual's spectrum. At most 10000
/// times are drawn.
void addRecordingFigures(const ShownRecording& shown, Page& page, Section& section);

}  // namespace twinmap
