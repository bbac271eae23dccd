#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/response_layout.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulates all columns of points; the first of them is the centre, whose integration steps the others may
/// take.
using SimulateNeighbours = std::function<void(const Eigen::MatrixXd& points, Eigen::MatrixXd& responses,
                                              std::vector<SampleStatus>& statuses)>;

/// How far a model's responses are from a smooth function of the parameters, and what follows for
/// differences.
struct DifferenceSteps {
  double noise = 0.0;  ///< of the responses, relative to each output's root mean square
  Eigen::VectorXd
      steps;  ///< for central differences, in widths of the bounds; kSharedStepsDifference or more

  bool areShared() const;  ///< all kSharedStepsDifference
};

/// Measures the noise at the centre of the box by fourth differences of nine points kSharedStepsDifference
/// apart (More and Wild, Estimating computational noise, 2011), of each output the median over the times, and
/// third derivatives by differences of an eighth of the widths. The step of least error is
/// (3 noise / third derivative)^(1/3), at most a twentieth of the width. Where a simulation fails all steps
/// are kSharedStepsDifference. Cost: 9 + 4 p simulations.
DifferenceSteps measureDifferenceSteps(const std::vector<ParameterSpec>& sampled,
                                       const ResponseLayout& layout, const SimulateNeighbours& simulate);

/// "noise of the solver 2.4e-05 of the outputs: differences over 0.015 to 0.05 of the bounds"
std::string describe(const DifferenceSteps& differences);

/// What Simulator::simulateAround() gives where responses are noisy: columns beside the centre, column 0, lie
/// on the tangent there, whose derivatives are differences over `steps`. A column whose derivatives need a
/// simulation that fails has its status. Only parameters that differ from the centre are stepped.
void simulateOnTangent(const std::vector<ParameterSpec>& sampled, const DifferenceSteps& differences,
                       const SimulateNeighbours& simulate, const Eigen::Ref<const Eigen::MatrixXd>& points,
                       Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses);

}  // namespace twinmap
