#pragma once

#include <memory>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulations of a point's stencil, its own included, for derivatives to so many parameters.
inline int countNeighbours(std::size_t parameters) {
  return 2 * static_cast<int>(parameters) + 1;
}

/// Simulates points together with the 2 p points beside each that its derivatives to p parameters, the first
/// of the point, need (makeNeighbours): a column of `responses` is theirs, one below the other, the point's
/// own first, then the two of each parameter. With exact derivatives (Simulator::hasDerivatives) the
/// responses beside a point are its own, continued along them; else all are simulated with the integration
/// steps of the point, or, by a simulator that mixes neighbours, as one batch. A point fails if one of its
/// simulations does.
void simulateStencils(Simulator& simulator, const std::vector<ParameterSpec>& parameters,
                      const Eigen::Ref<const Eigen::MatrixXd>& points, Eigen::Ref<Eigen::MatrixXd> responses,
                      SampleStatus* statuses);

/// Simulates the stencils of a simulator that has no derivatives, so that they can be stored and shared
/// like any sample. Its layout has as many rows; its outputs and modes are those of the simulator, repeated.
class StencilSimulator final : public Simulator {
 public:
  StencilSimulator(const Simulator& simulator, const std::vector<ParameterSpec>& parameters);

  const ResponseLayout& getLayout() const override { return layout_; }
  /// So many points as have their neighbours in one batch, where those of several points may mix.
  int getBatchSize() const override;
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override;
  std::unique_ptr<Simulator> clone() const override;

 private:
  std::unique_ptr<Simulator> simulator_;
  std::vector<ParameterSpec> parameters_;
  ResponseLayout layout_;
};

}  // namespace twinmap
