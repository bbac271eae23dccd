#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// A measured response (rows of the layout) to the chi-square that is left where the parameters explain it
/// as well as they can, in proportion where samples are missing (NaN); infinite where it has no features.
using MisfitOfResponse = std::function<double(const Eigen::VectorXd&)>;

/// The one simple fault of a measurement that explains nearly all of a misfit that no model's error has: an
/// output in another unit (by a factor of 1000, 57.3 or 9.81), with the other sign, with an offset or a
/// drift, clipped, held at one value for a while, wrapped as a counter, or with one to three spikes (of
/// evenly spaced samples), two outputs that are swapped, or several by one factor; in words, as "theta
/// is 57.3 times too large, as deg in the place of rad: divide it by 57.3"; "" where none leaves less than 1
/// % of `chi_square`, or chi_square is below 100 times `residuals`. signals: of the excitation, which may be
/// wrong in the place of all outputs. Cost: at most 60 evaluations an output, one a pair and 24.
std::string explainByFault(const Eigen::VectorXd& measured, const ResponseLayout& layout, double chi_square,
                           Eigen::Index residuals, const MisfitOfResponse& calcMisfit,
                           const std::vector<std::string>& signals = {});

}  // namespace twinmap
