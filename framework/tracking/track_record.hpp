#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/tracking/model.hpp"

namespace twinmap {

/// A quantity of a measurement that a parameter may follow where the model is wrong. Such are how large and
/// how fast its motion was, and the conditions.
struct Covariate {
  std::string name;
  double value = 0.0;
};

/// One measurement as it is tracked.
struct TrackRecord {
  std::string source, digest, status;
  std::vector<Covariate> covariates{};
  std::string trial{};            ///< of an experiment with trials
  std::optional<double> start{};  ///< time in its table that is 0 of the model, as it was given
  bool is_file = false;           ///< whether `source` is the path of its table
  Eigen::VectorXd estimate{};     ///< p, coordinates; empty of what does not update
  tracking::Measurement measurement{};

  /// Order in time; of equal times that of digests, whatever came first.
  bool isBefore(const TrackRecord& other) const;
  bool isSame(const TrackRecord& other) const {
    return digest == other.digest && measurement.time == other.measurement.time;
  }
};

/// A line of JSON, from which the same bits come back. parameters, conditions: of the model. Throws
/// std::runtime_error for a line that is none.
std::string writeRecord(const TrackRecord& record);
TrackRecord readRecord(const std::string& line, Eigen::Index parameters, Eigen::Index conditions);

}  // namespace twinmap
