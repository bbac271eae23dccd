#pragma once

#include <filesystem>

#include "framework/base/log/run_control.hpp"
#include "framework/optimal_design/excitation_design.hpp"

namespace twinmap::experiment_design {

/// Designs the excitation of an experiment (its design.excitation) and writes to `folder`: designed.yaml, the
/// whole experiment with the values found; signal.csv, its signals over time; design.csv, what was tried;
/// limits.csv, the information limit before and after; design.html. The criterion is averaged over a Latin
/// hypercube of the box; nuisance parameters are marginalised, known inputs averaged, the box is the prior.
/// Then the limits are held against 1000 random points and the corners; where they are broken the search goes
/// on with tighter ones. What design.csv has from an interrupted design of the same experiment is not
/// computed again. Throws ExperimentError for what cannot be free, for limits that no design keeps (naming
/// the one and the least violation found), and for a folder of another experiment; Interrupted where
/// `control` asks to stop, after the best so far has been written.
ExcitationDesign designExcitation(const YamlNode& tree, const std::filesystem::path& folder,
                                  const RunControl& control);

}  // namespace twinmap::experiment_design
