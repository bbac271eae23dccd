#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace twinmap {

/// Outcome of one simulation. A failed sample keeps its place; its response is NaN.
struct SampleStatus {
  bool ok = true;
  std::string reason;  ///< empty if ok: "body 'beam1': mass = 0 kg must be positive", "step limit ..."
};

/// A model that maps parameter sets to sampled responses. Not thread safe: clone() one for each thread,
/// serially, before the parallel loop.
///
/// A response column holds all outputs at all times, output by output:
/// response[o * times + i] is output o at getTimes()[i].
class Simulator {
 public:
  virtual ~Simulator() = default;

  virtual const std::vector<std::string>& getOutputNames() const = 0;
  virtual const std::vector<std::string>& getOutputUnits() const = 0;
  virtual const Eigen::VectorXd& getTimes() const = 0;

  /// Simulates a batch: column j of `parameters` (p x n) gives column j of `responses`
  /// (outputs * times x n) and statuses[j]. The result of a column does not depend on its batch. Numerical
  /// failure is a status, never an exception.
  virtual void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                        Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) = 0;

  virtual std::unique_ptr<Simulator> clone() const = 0;
};

}  // namespace twinmap
