#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/estimation/refined/measured_misfit.hpp"
#include "framework/estimation/refined/search_box.hpp"

namespace twinmap {

/// A misfit of samples at some of the times alone, each of which counts as many times as all are more. It is
/// as informative where the response is smooth, in so much less time. For steps, not for answers.
class ThinnedMisfit final : public MeasuredMisfit {
 public:
  /// Residuals of each feature that is kept: (measured - response[row]) * scale.
  struct Samples {
    std::vector<Eigen::Index> rows;  ///< of the simulator's layout
    Eigen::VectorXd measured, scale;
  };

  /// The simulator has derivatives. The box must outlive the object.
  ThinnedMisfit(std::unique_ptr<Simulator> simulator, Samples samples, const SearchBox& box)
      : simulator_(std::move(simulator)), samples_(std::move(samples)), box_(box) {}

  int getSimulations() const override { return simulations_; }
  std::vector<LocalMisfit> linearizeAll(const Eigen::MatrixXd& points) override;
  Eigen::VectorXd evaluate(const Eigen::MatrixXd& points) override;

 private:
  Eigen::VectorXd calcResidual(const Eigen::VectorXd& response) const;

  const std::unique_ptr<Simulator> simulator_;
  const Samples samples_;
  const SearchBox& box_;
  int simulations_ = 0;
};

/// Times (s, ascending), evenly chosen, at which so many times as many features are sampled as there are
/// unknown parameters; all of `features` are samples. Empty where these are less than half of all times.
Eigen::VectorXd chooseTimes(const ResponseLayout& layout, Eigen::Index features, Eigen::Index unknown);

}  // namespace twinmap
