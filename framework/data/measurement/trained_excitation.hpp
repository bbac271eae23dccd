#pragma once

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// The names of the columns by which a measurement may tell its excitation, for readTable(): of each signal
/// that is given as `measured`, that of its column, and its own.
std::vector<std::string> listExcitationColumns(const ExperimentSpec& experiment);

/// A map knows one excitation. Where the table has a column of a signal that is given as `measured` (loaded)
/// without a delay, the signal of the time `start` (s) of the table on is compared with the one that the map
/// was trained on; their rate may differ, and one may be shorter. Where it has none, that of the signal's own
/// file is, if the start has moved (followMeasuredSignals) and the file is there. Throws MeasurementError,
/// naming the signal, where they differ and by how much, where they are not the same: the scale differs by
/// more than 2 %, or the root mean square of the difference is above 10 % of the signal's. O(samples).
void requireTrainedExcitation(const ExperimentSpec& experiment, const Table& table, double start);

}  // namespace twinmap
