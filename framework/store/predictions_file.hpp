#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/estimation/estimate.hpp"

namespace twinmap {

/// predictions.csv as matrices: p x n, in the parameters' units.
struct StoredPredictions {
  std::vector<int> samples;  ///< index in the test set of each column of the truth
  Eigen::MatrixXd truth;
  Estimates predictions;
  Eigen::MatrixXd limit_stddev;  ///< NaN where it is not known; empty where the file has no such column
};

/// Reads components.csv (docs/reference/files.md): the mixture of each of `samples`, without its
/// correlations; empty if there is no such file. Throws as readPredictionsFile().
std::vector<Mixture> readComponentsFile(const std::filesystem::path& path,
                                        const std::vector<std::string>& parameters,
                                        const std::vector<int>& samples);

/// Reads predictions.csv (docs/reference/files.md); `parameters` are the names in its order. Numbers are
/// those that were written, bit for bit. Throws std::runtime_error naming the file, the row and what is wrong
/// with it.
StoredPredictions readPredictionsFile(const std::filesystem::path& path,
                                      const std::vector<std::string>& parameters);

}  // namespace twinmap
