#pragma once

#include <string>

#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {

struct Solution {
  Eigen::MatrixXd response, derivatives;  ///< rows: outputs, each at all times
};

inline Solution solveWithDerivatives(const ModelSpec& model, const Eigen::VectorXd& times,
                                     const Eigen::VectorXd& point) {
  MultibodySimulator simulator(model, times);
  Solution solution{Eigen::MatrixXd(simulator.getLayout().getRowCount(), 1), {}};
  SampleStatus status;
  simulator.simulateWithDerivatives(point, solution.response, solution.derivatives, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  return solution;
}

/// Against central differences through the same events, 1e-5 of the largest of each output. The steps are so
/// small that no event passes a time of output.
inline void expectExactEvents(ModelSpec model, const Eigen::VectorXd& point, double duration,
                              double share = 2e-5) {
  model.simulation.relative_tolerance = 1e-12;
  model.simulation.absolute_tolerance = 1e-15;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(14, 0.13 * duration, 0.97 * duration);
  const Solution exact = solveWithDerivatives(model, times, point);
  MultibodySimulator simulator(model, times);
  for (Eigen::Index k = 0; k < point.size(); ++k) {
    const double step = share * (model.parameters[k].bounds.upper - model.parameters[k].bounds.lower);
    Eigen::MatrixXd points = point.replicate(1, 2), responses(exact.response.rows(), 2);
    points(k, 0) -= step;
    points(k, 1) += step;
    SampleStatus statuses[2];
    simulator.simulate(points, responses, statuses);
    const Eigen::VectorXd differences = (responses.col(1) - responses.col(0)) / (2.0 * step);
    for (std::size_t o = 0; o < model.outputs.size(); ++o) {
      const auto rows = Eigen::seqN(static_cast<Eigen::Index>(o) * times.size(), times.size());
      EXPECT_LT((exact.derivatives.col(k)(rows) - differences(rows)).cwiseAbs().maxCoeff(),
                1e-5 * differences(rows).cwiseAbs().maxCoeff())
          << model.parameters[k].name.text << " of " << model.outputs[o].name.text;
    }
  }
}

}  // namespace twinmap::testing
