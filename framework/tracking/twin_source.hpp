#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/inference/measurement/inference_source.hpp"

namespace twinmap {

/// By the extension of its name: else it is a run.
bool isExperimentFile(const std::filesystem::path& path);

/// What the measurements of one machine are inferred by: a run or an experiment, or each trial of an
/// experiment by itself. Immutable, for any number of threads.
class TwinSource {
 public:
  struct Member {
    std::string trial;  ///< "" of an experiment without trials
    std::unique_ptr<const InferenceSource> source;
  };

  /// The folder of a run, its maps.h5, or an experiment file. Throws as InferenceSource does, and
  /// ExperimentError for a run of several trials: its estimator needs recordings of all of them at once.
  explicit TwinSource(const std::filesystem::path& run_or_experiment);
  /// An experiment's tree.
  explicit TwinSource(const YamlNode& root);

  const std::vector<Member>& getMembers() const { return members_; }
  /// Of a recording. Throws ExperimentError for an unknown trial, and where there are trials and none is
  /// named.
  std::size_t find(const std::string& trial) const;

  /// The machine's model: parameters and priors are the same in all trials.
  const ModelSpec& getModel() const { return members_.front().source->getExperiment().model; }
  const std::string& getName() const { return members_.front().source->getExperiment().name.text; }
  /// All of it, and what it is inferred by.
  std::string describe() const;

 private:
  std::vector<Member> members_;
};

}  // namespace twinmap
