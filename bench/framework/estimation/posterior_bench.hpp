#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/estimation/refined/refinement_model.hpp"
#include "framework/inference/measurement/measurement_inference.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

struct StudyRequest {
  std::string file;
  int tests = 60, draws = SimulatorPosteriorOptions{}.draws;
  std::uint64_t seed = 1;
  int reference = 0;                   ///< draws of posteriors to compare with; 0: none
  std::map<std::string, double> held;  ///< truths that are not drawn
};

/// A measurement of a machine that is known.
struct Measured {
  Eigen::VectorXd truth;  ///< of the sampled box
  Eigen::VectorXd features;
  double chi_square = 0.0;  ///< of the truth
  Eigen::VectorXd limit;    ///< p: standard deviations
};

/// What was inferred of it.
struct Judged {
  bool reliable = false, ok = false, missed = false;
  std::string status, ridges;         ///< statuses, and what was identified; joined; of all answers
  Eigen::VectorXd z, held95, held50;  ///< p; 1 where the interval holds
  Eigen::VectorXd error, limit;       ///< p, in widths
  Eigen::VectorXd stddev;             ///< likewise, of the posterior
  Eigen::VectorXi ranks;              ///< p + 1
  /// p: of mean, in sds, and sd against those of more draws, as shares; empty where none are asked for.
  Eigen::VectorXd mean_error, stddev_error;
  double seconds = 0.0, simulations = 0.0, size = 0.0, pareto_shape = 0.0;
  double chi_square = 0.0, excess = 0.0;  ///< of the best fit; above that of the truth
  int found_best = 0, starts = 0;

  std::string describe() const;
};

/// Machines drawn from the bounds of an experiment, measured and inferred without a run, as `infer` does. The
/// measurements are simulated with tolerances a hundredth of those that the inference takes.
class PosteriorBench {
 public:
  explicit PosteriorBench(const StudyRequest& request);

  const std::vector<ParameterSpec>& getParameters() const { return experiment_.model.parameters; }

  /// Nothing where the machine cannot be simulated; the reason is in `failure`.
  std::optional<Measured> measure(int test, std::string& failure) const;

  /// With the random numbers of `infer`, which are the same for every measurement.
  Judged judge(const Measured& measured, int test) const;

 private:
  Eigen::VectorXd drawTruth(int test) const;
  InferredMeasurement infer(const Measured& measured, int draws, std::uint64_t seed) const;
  void compare(const Estimate& estimate, const Measured& measured, int test, Judged& judged) const;
  void compareWithMore(const Estimate& estimate, const Measured& measured, int test, Judged& judged) const;
  Eigen::VectorXi rank(const Estimate& estimate, const Eigen::VectorXd& truth, int test) const;

  const StudyRequest request_;
  const ExperimentSpec experiment_;
  const ResponseLayout layout_;
  const FeatureExtractor extractor_;
  const ResponseNoise response_noise_;
  const FeatureNoise noise_;
  const std::unique_ptr<Simulator> machine_;
  const std::vector<ParameterSpec> unknown_, sampled_;
  const RefinementModel model_;
};

}  // namespace twinmap
