#pragma once

#include <filesystem>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap {

/// Writes samples.h5 (docs/reference/files.md): parameters and clean responses of the training and the test
/// set, failed samples included (responses NaN, with their reason). Equal content gives equal bytes.
void writeSamplesFile(const std::filesystem::path& path, const ModelSpec& model, const Trajectories& train,
                      const Trajectories& test);

/// How many training samples a samples.h5 has, failed ones included. Throws std::runtime_error for a file
/// that is not a samples.h5.
int countTrainingSamples(const std::filesystem::path& path);

/// The clean responses of the test set, with the times they are known at.
struct StoredResponses {
  std::vector<std::string> output_names;
  std::vector<std::string> output_units;
  Eigen::VectorXd times;      ///< s
  Eigen::MatrixXd responses;  ///< outputs * times x n, output by output; NaN where the sample failed
};

/// Reads the test set's responses back. Throws std::runtime_error for a file that is not a samples.h5.
StoredResponses readTestResponses(const std::filesystem::path& path);

/// The training and the test set of samples.h5, as they were written.
struct StoredSamples {
  Trajectories train, test;
};

/// Reads samples.h5 back. Throws std::runtime_error for a file that is not a samples.h5.
StoredSamples readSamplesFile(const std::filesystem::path& path);

}  // namespace twinmap
