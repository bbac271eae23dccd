#pragma once

#include <vector>

#include "framework/report/figure.hpp"
#include "framework/results/gates.hpp"
#include "framework/results/run_folder.hpp"

namespace twinmap {

// The chapters of a run's page, in reading order. Each adds one section with its figures, their tables and
// the texts to copy. Where the folder lacks the data, a chapter is left out or says how to get it.

void addVerdict(const RunFolder& run, const std::vector<GateResult>& gates, Page& page);
/// Of each parameter the error, the limit and the coverage; "" of none.
std::string makeErrorsTable(const CsvTable& metrics);
void addMetrics(const RunFolder& run, Page& page);
/// How good the map alone is, and what refinement makes of its answers.
void addMethods(const RunFolder& run, Page& page);
/// Several maps on the same samples, where the experiment asks for them.
void addComparedMaps(const RunFolder& run, Page& page);
/// A typical estimate beside its bounds, and which parameters are correlated.
void addParameters(const RunFolder& run, Page& page);
/// Curves that the model has, true and estimated, with their bands.
void addCurves(const RunFolder& run, Page& page);
void addInferred(const RunFolder& run, Page& page);
void addStddevOverBox(const RunFolder& run, Page& page);
void addCalibration(const RunFolder& run, Page& page);
/// The figure that holds the map against an exact posterior, where there is one.
void addPosterior(const RunFolder& run, Section& section, Page& page);
/// The figure of simulation-based calibration, where there is one.
void addRanks(const RunFolder& run, Section& section, Page& page);
void addResponses(const RunFolder& run, Page& page);
void addFeatures(const RunFolder& run, Page& page);
/// Which combinations of parameters the data determine.
void addCombinations(const RunFolder& run, Section& section, Page& page);
/// Which inputs each parameter's process depends on, and how the data tie parameters together.
void addRelevance(const RunFolder& run, Section& section, Page& page);
void addCorrelations(const RunFolder& run, Section& section, Page& page);
void addTraining(const RunFolder& run, Page& page);
void addCost(const RunFolder& run, Page& page);
/// Where in the box and why samples could not be simulated.
void addFailures(const RunFolder& run, Section& section, Page& page);

/// The chapters of a sweep's page that a run's has not.
void addSweepVerdict(const SweepFolder& sweep, const RunFolder* shown, const std::vector<GateResult>& gates,
                     Page& page);
void addSweep(const SweepFolder& sweep, Page& page);

/// Several runs side by side.
void addComparison(const std::vector<RunFolder>& runs, Page& page);

}  // namespace twinmap
