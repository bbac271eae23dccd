#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "framework/estimation/refined/local_misfit.hpp"
#include "framework/estimation/refined/refinement_model.hpp"

namespace twinmap {

/// Numbers of responses and derivatives that are held together: 64 MiB.
constexpr Eigen::Index kNumbersTogether = Eigen::Index{1} << 23;

/// How badly a simulator explains a measurement, in units of its noise, over unknown parameters in
/// half-widths of their bounds. One thread.
class MeasuredMisfit {
 public:
  virtual ~MeasuredMisfit() = default;

  virtual int getSimulations() const = 0;

  /// At all columns of `points` (s x n), simulated as one batch, with derivatives.
  virtual std::vector<LocalMisfit> linearizeAll(const Eigen::MatrixXd& points) = 0;

  /// The misfits at the columns of `points` (s x n), simulated as one batch; infinity where a simulation
  /// fails. After linearizeAll().
  virtual Eigen::VectorXd evaluate(const Eigen::MatrixXd& points) = 0;

  /// The same of fewer samples (ThinnedMisfit), where their simulation costs as much less; else null. What
  /// this refers to must outlive it.
  virtual std::unique_ptr<MeasuredMisfit> makeThinned() const { return nullptr; }

  /// Of a measurement that may be looked at through windows, or under a hypothesis of its noise. From now on
  /// at the features of a window alone.
  virtual void setWindow(const GrowingWindow& /*window*/) { throw std::logic_error("has no windows"); }
  /// evaluate() of other losses, of whitened residuals (k x n), without the prior.
  virtual Eigen::VectorXd sumUp(const Eigen::MatrixXd& /*points*/,
                                const std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>& /*losses*/) {
    throw std::logic_error("has no residuals that a hypothesis could explain");
  }
};

}  // namespace twinmap
