#pragma once

#include <optional>

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// The experiment with its features at the times of a recording, so that nothing is interpolated: each output
/// is sampled at the recorded times about those at which the features ask for it; at all of them where they
/// are about as many, else at the nearest of each. Interpolated samples carry the cubic's error, and their
/// noise is smaller and correlated.
///
/// None where all but a hundredth of the features have a sample of their own or none near; where a feature is
/// not a sample of an output; where the model is not a system that the experiment describes, as others may
/// step from one output time to the next; and of an output whose stated noise is correlated, unless the
/// recorded times are on the grid of that. start: the time in the table (s) that is the model's 0. layout:
/// the experiment's. Throws MeasurementError as readAvailable() does. O(rows log rows).
std::optional<ExperimentSpec> followRecordedTimes(const ExperimentSpec& experiment,
                                                  const ResponseLayout& layout, const Table& table,
                                                  double start);

/// Whether all features are samples of outputs.
bool areSamples(const std::vector<FeatureSpec>& features);

/// Times as blocks of equidistant samples of an output, as few as a single pass finds; each time within 1e-7
/// of their mean step.
std::vector<FeatureSpec> makeSamplesAt(const std::string& output, const std::vector<double>& times);

}  // namespace twinmap
