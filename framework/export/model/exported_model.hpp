#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// A finished run as what leaves twinmap sees it.
struct ExportedModel {
  ExperimentSpec experiment;
  ResponseLayout layout;
  std::optional<double> sample_interval;  ///< the smallest at which a feature samples the outputs, s
  std::vector<FeatureInfo> features;      ///< d
  OnlineModel online;

  /// Null where the map is of another kind.
  const GpMap* findProcesses() const;
  const Surrogate* findSurrogate() const;
  const NetworkMap* findNetwork() const;
  /// The processes from parameters to scores, of the map or else of the trust model; or null.
  const ForwardSurrogate* findForward() const;

  /// What is known of the unknowns before, as that of the map or else of the trust model has it; or null.
  const BoxPrior* findPrior() const;

  Eigen::Index countParameters() const;
  Eigen::Index countKnown() const;             ///< inputs of the set-up
  Eigen::Index countUnknown() const;           ///< of the sampled box, nuisance parameters included
  Eigen::MatrixXd getCorrelation() const;      ///< of the errors of a sample's parameters
  Eigen::VectorXd getIntervalFactors() const;  ///< half widths of 95 % intervals, in standard deviations
  Eigen::VectorXd getBoxCenter() const;        ///< of the sampled box
  Eigen::VectorXd getBoxHalfWidth() const;

  /// Whether features are made of measured signals; of modes they are not.
  bool takesSignals() const { return layout.modes == 0; }
};

/// Reads the folder of a finished run, or its maps.h5. Throws std::runtime_error for a file that is missing
/// or was made by another version.
ExportedModel loadExportedModel(const std::filesystem::path& run_or_maps);

}  // namespace twinmap
