#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Outcome of one simulation. A failed sample keeps its place; its response is NaN.
struct SampleStatus {
  bool ok = true;
  std::string reason;  ///< empty if ok: "body 'beam1': mass = 0 kg must be positive", "step limit ..."
  bool machine_dependent = false;  ///< a failure that another try may not repeat: the wall-time limit
  bool stiff_retry = false;  ///< by an implicit method, after the explicit one had reached its step limit
};

/// A model that maps parameter sets to responses (columns, see ResponseLayout). Not thread safe: clone() one
/// for each thread, serially, before the parallel loop.
class Simulator {
 public:
  virtual ~Simulator() = default;

  virtual const ResponseLayout& getLayout() const = 0;

  /// Simulates a batch: column j of `parameters` (p x n) gives column j of `responses`
  /// (rows of the layout x n) and statuses[j]. The result of a column does not depend on its batch. Numerical
  /// failure is a status, never an exception.
  virtual void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                        Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) = 0;

  /// Columns that are best handed to simulate() at once.
  virtual int getBatchSize() const { return 1; }

  /// As simulate(), but all columns take the integration steps that column 0, their centre, needs: responses
  /// are then smooth functions of the parameters, and differences of them are derivatives to the accuracy of
  /// the integration itself. A simulator without step control leaves it as it is; one whose responses are
  /// noisy puts the columns on the tangent at the centre, from differences of its own steps.
  virtual void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                              Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
    simulate(parameters, responses, statuses);
  }

  /// Whether simulateAround() is simulate(): neighbours of several points may then come as one batch.
  virtual bool mixesNeighbours() const { return false; }

  /// Whether simulateWithDerivatives() may be called.
  virtual bool hasDerivatives() const { return false; }

  /// As simulate(), with the exact derivatives of the responses, up to the integration's tolerance: column j
  /// * p + k of `derivatives` (rows of the layout x n p, resized) is that of column j's response with respect
  /// to parameter k of its point. Where a sample failed they may be anything.
  virtual void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                       Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                                       SampleStatus* statuses);

  virtual std::unique_ptr<Simulator> clone() const = 0;

  /// What simulates, for the log: "lanes", "fmu crane.fmu (FMI 2.0, co_simulation)".
  virtual const std::string& getEngine() const;

  /// What simulates, in words: "vectorised solver (built-in)".
  std::string describeEngine() const;

  /// The machine in a few lines "name    value" for the eye: what moves, loops, equilibrium, modes. Empty
  /// where nothing is known of it. Some milliseconds.
  virtual std::vector<std::string> describeModel() { return {}; }

  /// How noisy the responses are and what differences of them are taken over, for the log; "" where they are
  /// smooth for a known reason. Measures the noise if that has not been done yet.
  virtual std::string describeDifferences() { return ""; }

  /// Throws ExperimentError unless a simulation at the centre of the bounds could begin. Cheap beside
  /// many simulations.
  virtual void checkStart() {}

  /// The same model at some of its times alone (s, ascending); null where these cost as much as all, since
  /// what lies between is integrated.
  virtual std::unique_ptr<Simulator> cloneAt(const Eigen::VectorXd& /*times*/) const { return nullptr; }

  /// The same model, integrated with errors some hundred times smaller; null where it cannot be. For
  /// responses that amplify the errors of the integration. From any thread.
  virtual std::unique_ptr<Simulator> clonePrecisely() const { return nullptr; }
};

/// Throws ExperimentError where the times of a response do not rise from 0 s on to the simulation's duration.
void checkSampleTimes(const Eigen::VectorXd& times, double duration);

}  // namespace twinmap
