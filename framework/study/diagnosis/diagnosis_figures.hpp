#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/picture/output_residuals.hpp"
#include "framework/diagnosis/picture/unknown_force.hpp"
#include "framework/report/figure.hpp"

namespace twinmap {

/// What the figures of a diagnosis are about.
struct DrawnDiagnosis {
  const Diagnosis& diagnosis;
  const RecordedFeatures& recordings;
  const FitMotion& motion;
  std::vector<std::string> names;  ///< of the recordings that are drawn
};

/// The force on each coordinate that is missing from the model, over speed, position and time; its data go to
/// the page.
Section makeForceSection(const DrawnDiagnosis& drawn, const std::vector<UnknownForce>& forces, Page& page);

/// The residual of each output over time, over a coordinate and its speed, and its spectrum, likewise.
Section makeResidualSection(const DrawnDiagnosis& drawn, const std::vector<OutputResidual>& residuals,
                            Page& page);

}  // namespace twinmap
