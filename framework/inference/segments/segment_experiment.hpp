#pragma once

#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/inference/segments/segment_states.hpp"

namespace twinmap {

/// How a recording is cut: whole samples, every one in one segment.
struct SegmentGrid {
  double offset = 0.0, interval = 0.0;  ///< s, of the samples
  int samples = 0;                      ///< of a segment
  int count = 0;                        ///< segments

  double getLength() const { return samples * interval; }  ///< s
  /// Of segment k, s.
  double calcStart(int k) const;
};

/// The grid of segments of about `length` s, as the experiment's features sample the outputs, in a recording
/// that ends at `end` s. Throws ExperimentError, which says what to do, where an experiment cannot be
/// inferred in segments: features other than samples at one interval, what keeps states that no file can
/// start (controllers, sensors with a memory, stops and friction that switch), constraints, a model from
/// elsewhere; fewer samples in a segment than free states; no whole segment in the recording.
SegmentGrid makeSegmentGrid(const ExperimentSpec& experiment, double length, double end);

/// The experiment with its features over a whole recording in a grid.
ExperimentSpec makeRecordingExperiment(ExperimentSpec experiment, const SegmentGrid& grid);

/// The experiment of a segment: the states at its start are nuisance parameters, the last of all unknown, the
/// time of its start is the last input (ModelSpec::time_origin). Nuisance parameters that only gave the
/// file's initial state are none here. Throws ExperimentError for a parameter that nothing else needs.
ExperimentSpec makeSegmentExperiment(ExperimentSpec experiment, const SegmentGrid& grid,
                                     const std::vector<StartState>& states, const StateGuess& guess);

}  // namespace twinmap
