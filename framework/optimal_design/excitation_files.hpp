#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "framework/optimal_design/excitation_design.hpp"

namespace twinmap::experiment_design {

/// What was tried: columns evaluation, points (averaged, nominal), criterion, violation, failure, then the
/// free values and the measures of the limits.
class TrialFile {
 public:
  /// Reads the file, where it is there.
  TrialFile(std::filesystem::path path, const std::vector<FreeNumber>& numbers,
            const std::vector<Limit>& limits);

  /// The score of a design that the file has, or null.
  const DesignScore* find(const std::string& points, const Eigen::VectorXd& values) const;
  /// Adds one; the file is written every 50 designs.
  void add(const std::string& points, const Eigen::VectorXd& values, const DesignScore& score);
  void write() const;

 private:
  std::string makeKey(const std::string& points, const Eigen::VectorXd& values) const;

  std::filesystem::path path_;
  const std::vector<FreeNumber>& numbers_;
  const std::vector<Limit>& limits_;
  std::map<std::string, DesignScore> known_;
  std::vector<std::vector<std::string>> rows_;
};

/// Writes designed.yaml, signal.csv and limits.csv.
void writeDesign(const std::filesystem::path& folder, const ExcitationEvaluator& evaluator,
                 const ExcitationDesign& design);

/// For people: limits of the parameters before and after, and the measures of the limits.
std::string describeDesign(const ExcitationDesign& design);

}  // namespace twinmap::experiment_design
