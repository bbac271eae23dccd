#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "framework/diagnosis/picture/fit_motion.hpp"
#include "framework/report/figure.hpp"

namespace twinmap {

/// What the figures of a diagnosis are about.
struct DrawnDiagnosis {
  const Diagnosis& diagnosis;
  const RecordedFeatures& recordings;
  const FitMotion& motion;
  std::vector<std::string> names;  ///< of the recordings that are drawn
};

using NamedColumns = std::vector<std::pair<std::string, Eigen::VectorXd>>;

/// Columns that grow by one recording after the other; the first names it by its number.
class RecordingTable {
 public:
  void add(std::size_t recording, const NamedColumns& columns);
  DataTable make() const;

 private:
  std::vector<std::string> recordings_;
  std::map<std::string, std::vector<double>> columns_;
};

/// Which recording is shown, "{recording}" of the panels: the reader's choice, where there are several.
void addRecordingChoice(const std::vector<std::string>& names, Figure& figure);

/// "m/s"
std::string makeSpeedUnit(const ForcedCoordinate& coordinate);

}  // namespace twinmap
