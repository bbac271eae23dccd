#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/base/json/json_fwd.hpp"

namespace twinmap::robots {

/// What an inference says of parameters.
struct RobotEstimate {
  std::string source;  ///< file, for messages
  std::string status;  ///< "ok", or why not
  std::vector<std::string> names;
  std::vector<double> means, stddevs;
  std::vector<std::string> units;
  std::vector<std::vector<double>> covariance;  ///< empty: not stated

  std::map<std::string, double> getMeans() const;
};

/// The first estimate of a text that `twinmap infer --json` wrote. Throws ExperimentError for another text
/// and for an estimate that states no parameters.
RobotEstimate readEstimate(const std::string& text, const std::string& source);

/// Throws ExperimentError unless the status is ok.
void requireOk(const RobotEstimate& estimate);

/// Values, sds, status and correlations, and which parameters have no place in the robot's file.
std::string makeUpdateJson(const RobotEstimate& estimate, const std::vector<std::string>& without_place);

/// Draws of a normal distribution with the estimate's mean and covariance, by number: the same for the same
/// number. Throws ExperimentError where no covariance is stated, or it is none.
class EstimateDraws {
 public:
  explicit EstimateDraws(const RobotEstimate& estimate);
  std::map<std::string, double> draw(int number) const;

 private:
  const RobotEstimate& estimate_;
  std::vector<std::vector<double>> factor_;  ///< F F' is the covariance
};

}  // namespace twinmap::robots
