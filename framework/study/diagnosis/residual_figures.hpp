#pragma once

#include <vector>

#include "framework/diagnosis/picture/output_residuals.hpp"
#include "framework/study/diagnosis/drawn_diagnosis.hpp"

namespace twinmap {

/// The residual of each output over time, over a coordinate and its speed, and its spectrum; their data go to
/// the page.
Section makeResidualSection(const DrawnDiagnosis& drawn, const std::vector<OutputResidual>& residuals,
                            Page& page);

}  // namespace twinmap
