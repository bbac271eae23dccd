#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/random/random.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/diagnosis/scored_candidates.hpp"

namespace twinmap {

/// A machine that has a term more than its model.
struct IncompleteMachine {
  ExperimentSpec experiment;
  Eigen::VectorXd point;  ///< of its parameters, those of the model first
  bool is_alike = false;  ///< whether another term does the same to within what evidence could tell
};

/// Of chi-square over its mean, after the best fit without a term: between these, uniform in the logarithm.
struct Ratios {
  double least = 1.2, most = 30.0;
};

/// Draws machines from the bounds of a model, and measures them.
class MachineMaker {
 public:
  MachineMaker(const std::string& file, std::uint64_t seed, const Ratios& ratios = {});

  const ExperimentSpec& getModel() const { return model_; }
  const ResponseLayout& getLayout() const { return layout_; }
  Eigen::Index getParameterCount() const { return shared_; }

  /// "none", each candidate that is visible at the centre of the box, and "process.x" of each coordinate: a
  /// random force on it.
  std::vector<std::string> listTerms() const;

  /// The machine number `test` with a term, or two ("coulomb.x+delay.F"), each of such a size that chi-square
  /// is between the ratios with it alone; the model itself for "none". None where a term does nothing there.
  std::optional<IncompleteMachine> make(const std::string& term, int test) const;

  /// The features of a machine, with noise; none where it cannot be simulated.
  std::optional<Eigen::VectorXd> measure(const ExperimentSpec& machine, const Eigen::VectorXd& point,
                                         int test, int repeat) const;

 private:
  double drawUniform(int test, Eigen::Index channel) const;
  double drawRatio(int test) const;
  Eigen::VectorXd drawPoint(int test) const;
  ScoredCandidates score(const Eigen::VectorXd& point) const;
  TermCandidate makeGust(const std::string& coordinate, int test) const;
  bool addMissing(const std::string& term, int test, int drawn, IncompleteMachine& machine) const;
  double drawSize(const ExperimentSpec& machine, const Eigen::VectorXd& point, const Eigen::VectorXd& added,
                  int test) const;

  const ExperimentSpec model_;
  const ResponseLayout layout_;
  const FeatureExtractor extractor_;
  const ResponseNoise noise_;
  const RandomStream random_;
  const std::uint64_t seed_;
  const Ratios ratios_;
  const Eigen::Index shared_;
};

/// Whether a term is a random force on a coordinate.
bool isProcess(const std::string& term);

}  // namespace twinmap
