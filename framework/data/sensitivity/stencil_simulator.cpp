#include "framework/data/sensitivity/stencil_simulator.hpp"

#include <algorithm>

#include "framework/simulation/stencil.hpp"

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

SampleStatus findFirstFailure(const std::vector<SampleStatus>& statuses) {
  const auto failed =
      std::find_if(statuses.begin(), statuses.end(), [](const SampleStatus& status) { return !status.ok; });
  return failed == statuses.end() ? SampleStatus{} : *failed;
}

void simulateEach(Simulator& simulator, const std::vector<ParameterSpec>& parameters,
                  const Eigen::Ref<const MatrixXd>& points, Eigen::Ref<MatrixXd> responses,
                  SampleStatus* statuses) {
  MatrixXd own(simulator.getLayout().getRowCount(), countNeighbours(parameters.size()));
  std::vector<SampleStatus> own_statuses(own.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    simulator.simulateAround(makeNeighbours(parameters, points.col(i)), own, own_statuses.data());
    statuses[i] = findFirstFailure(own_statuses);
    responses.col(i) = own.reshaped();
  }
}

/// As one batch, so that its size is that of the simulator whatever a point's number of neighbours is.
void simulateMixed(Simulator& simulator, const std::vector<ParameterSpec>& parameters,
                   const Eigen::Ref<const MatrixXd>& points, Eigen::Ref<MatrixXd> responses,
                   SampleStatus* statuses) {
  const Index each = countNeighbours(parameters.size()), rows = simulator.getLayout().getRowCount();
  MatrixXd all(points.rows(), each * points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    all.middleCols(i * each, each) = makeNeighbours(parameters, points.col(i));
  }
  MatrixXd own(rows, all.cols());
  std::vector<SampleStatus> own_statuses(own.cols());
  simulator.simulate(all, own, own_statuses.data());
  for (Index i = 0; i < points.cols(); ++i) {
    const auto first = own_statuses.begin() + i * each;
    statuses[i] = findFirstFailure({first, first + each});
    responses.col(i) = own.middleCols(i * each, each).reshaped();
  }
}

/// Without derivatives.
void simulateAll(Simulator& simulator, const std::vector<ParameterSpec>& parameters,
                 const Eigen::Ref<const MatrixXd>& points, Eigen::Ref<MatrixXd> responses,
                 SampleStatus* statuses) {
  const auto run = simulator.mixesNeighbours() ? simulateMixed : simulateEach;
  run(simulator, parameters, points, responses, statuses);
}

void continueAlongDerivatives(Simulator& simulator, const std::vector<ParameterSpec>& parameters,
                              const Eigen::Ref<const MatrixXd>& points, Eigen::Ref<MatrixXd> responses,
                              SampleStatus* statuses) {
  const Index p = points.rows(), rows = simulator.getLayout().getRowCount();
  MatrixXd centers(rows, points.cols()), derivatives;
  simulator.simulateWithDerivatives(points, centers, derivatives, statuses);
  for (Index i = 0; i < points.cols(); ++i) {
    const MatrixXd neighbours = makeNeighbours(parameters, points.col(i));
    for (Index k = 0; k < neighbours.cols(); ++k) {
      auto response = responses.col(i).segment(k * rows, rows);
      response = centers.col(i);
      for (Index j = 0; j < p; ++j) {
        if (const double step = neighbours(j, k) - points(j, i);
            step != 0.0) {  // one parameter moves, or none
          response += derivatives.col(i * p + j) * step;
        }
      }
    }
  }
}

}  // namespace

void simulateStencils(Simulator& simulator, const std::vector<ParameterSpec>& parameters,
                      const Eigen::Ref<const MatrixXd>& points, Eigen::Ref<MatrixXd> responses,
                      SampleStatus* statuses) {
  const auto run = simulator.hasDerivatives() ? continueAlongDerivatives : simulateAll;
  run(simulator, parameters, points, responses, statuses);
}

StencilSimulator::StencilSimulator(const Simulator& simulator, const std::vector<ParameterSpec>& parameters)
    : simulator_(simulator.clone()),
      parameters_(parameters),
      layout_(repeat(simulator.getLayout(), countNeighbours(parameters.size()))) {}

void StencilSimulator::simulate(const Eigen::Ref<const MatrixXd>& parameters, Eigen::Ref<MatrixXd> responses,
                                SampleStatus* statuses) {
  simulateAll(*simulator_, parameters_, parameters, responses, statuses);
}

int StencilSimulator::getBatchSize() const {
  const int each = countNeighbours(parameters_.size());
  return simulator_->mixesNeighbours() ? std::max(1, simulator_->getBatchSize() / each) : 1;
}

std::unique_ptr<Simulator> StencilSimulator::clone() const {
  return std::make_unique<StencilSimulator>(*simulator_, parameters_);
}

}  // namespace twinmap
