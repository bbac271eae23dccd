#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "framework/response/response_layout.hpp"

namespace twinmap {

/// Outcome of one simulation. A failed sample keeps its place; its response is NaN.
struct SampleStatus {
  bool ok = true;
  std::string reason;  ///< empty if ok: "body 'beam1': mass = 0 kg must be positive", "step limit ..."
  bool machine_dependent = false;  ///< a failure that another try may not repeat: the wall-time limit
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

  /// As simulate(), but all columns take the integration steps that column 0, their centre, needs: responses
  /// are then smooth functions of the parameters, and differences of them are derivatives to the accuracy of
  /// the integration itself. A simulator without step control leaves it as it is.
  virtual void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                              Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
    simulate(parameters, responses, statuses);
  }

  virtual std::unique_ptr<Simulator> clone() const = 0;
};

}  // namespace twinmap
