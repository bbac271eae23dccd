#include "framework/sensitivity/neighbourhood_simulator.hpp"

#include "framework/sensitivity/stencil.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

ResponseLayout repeat(const ResponseLayout& layout, int times) {
  ResponseLayout repeated;
  repeated.times = layout.times;
  repeated.modes = times * layout.modes;
  for (int i = 0; i < times; ++i) {
    repeated.output_names.insert(repeated.output_names.end(), layout.output_names.begin(),
                                 layout.output_names.end());
    repeated.output_units.insert(repeated.output_units.end(), layout.output_units.begin(),
                                 layout.output_units.end());
  }
  return repeated;
}

}  // namespace

SampleStatus simulateNeighbours(Simulator& simulator, const MatrixXd& points,
                                Eigen::Ref<MatrixXd> responses) {
  std::vector<SampleStatus> statuses(points.cols());
  simulator.simulateAround(points, responses, statuses.data());
  for (const SampleStatus& status : statuses) {
    if (!status.ok) {
      return status;
    }
  }
  return {};
}

NeighbourhoodSimulator::NeighbourhoodSimulator(const Simulator& simulator,
                                               const std::vector<ParameterSpec>& parameters)
    : simulator_(simulator.clone()),
      parameters_(parameters),
      layout_(repeat(simulator.getLayout(), countNeighbours(parameters.size()))) {}

void NeighbourhoodSimulator::simulate(const Eigen::Ref<const MatrixXd>& parameters,
                                      Eigen::Ref<MatrixXd> responses, SampleStatus* statuses) {
  MatrixXd own(simulator_->getLayout().getRowCount(), countNeighbours(parameters_.size()));
  for (Index i = 0; i < parameters.cols(); ++i) {
    statuses[i] = simulateNeighbours(*simulator_, makeNeighbours(parameters_, parameters.col(i)), own);
    responses.col(i) = own.reshaped();
  }
}

std::unique_ptr<Simulator> NeighbourhoodSimulator::clone() const {
  return std::make_unique<NeighbourhoodSimulator>(*simulator_, parameters_);
}

}  // namespace twinmap
