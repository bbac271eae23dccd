#pragma once

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Fills those tables of the excitation that are given as `measured` and have no values yet: from t = 0 to
/// the end of the simulation (or of the excerpt, if that is earlier), both moved by the delays within the
/// parameters' bounds, and a few samples beside, converted to the signal's unit. Files are found as their
/// names are written. Throws MeasurementError, naming the YAML key, the file and what is wrong with it.
void loadMeasuredSignals(ExperimentSpec& experiment);

/// Replaces the values of the same tables by those of another recording, whose time `start` (s) is t = 0: by
/// its columns where it has them, else by those of their own files, which share its time. A trigger
/// (measurement.start.when) is the start of both.
void replaceMeasuredSignals(ExperimentSpec& experiment, const Table& recording, double start);

/// Whether a prescribed motion takes the signal's speed and acceleration.
bool isFollowed(const SignalSpec& signal, const ModelSpec& model);

/// The same, but where a recording ends within `beside` (s) of the simulation, its first and last value are
/// held, but of a signal that a motion follows: where it stopped, its accelerations would be those of a blow;
/// a file of its own is read only where the start has moved. Whether any value changed. Throws
/// MeasurementError, naming the file, where it cannot be read, has a gap that cannot be bridged (bridgeGaps),
/// or does not cover the simulation.
bool followMeasuredSignals(ExperimentSpec& experiment, const Table& recording, double start, double beside);

/// The measured tables of a signal go on for `beside` (s) before and after the simulation, by their first and
/// last values where they end.
void holdMeasuredEnds(SignalSpec& signal, double duration, double beside);

/// Times and values of measured tables, by the names of their signals.
void copyMeasuredSignals(const std::vector<SignalSpec>& from, ModelSpec& model);

/// Empties the tables whose file is there to be read again.
void dropMeasuredSignals(ExperimentSpec& experiment);

/// The names of the columns that tables given as `measured` need, for readTable().
std::vector<std::string> listSignalColumns(const ExperimentSpec& experiment);

}  // namespace twinmap
