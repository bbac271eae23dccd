#pragma once

#include <string>

#include "framework/report/run_summary.hpp"

namespace twinmap {

/// The paper's Figure 3 for one parameter, as SVG: a point per test sample over the two parameters of
/// run.axes, coloured by the inferred standard deviation, with a colour bar. Needs run.axes.
std::string makeStddevFigure(const RunSummary& run, int parameter);

}  // namespace twinmap
