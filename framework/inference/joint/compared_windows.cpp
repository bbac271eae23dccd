#include "framework/inference/joint/compared_windows.hpp"

#include <algorithm>
#include <functional>

#include "framework/analysis/course.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// What the windows that count say: of each parameter (rows) of each window.
struct Stated {
  std::vector<InferredMeasurement*> windows;
  MatrixXd means, stddevs;
  VectorXd starts;
};

Stated collectStated(std::vector<InferredMeasurement>& windows, Index p) {
  Stated stated{{}, MatrixXd(p, 0), MatrixXd(p, 0), {}};
  for (InferredMeasurement& window : windows) {
    const Estimate estimate = selectEstimate(window);
    if (!estimate.isGiven() || misleads(estimate.statuses)) {
      continue;
    }
    const auto count = static_cast<Index>(stated.windows.size()) + 1;
    stated.windows.push_back(&window);
    stated.means.conservativeResize(Eigen::NoChange, count);
    stated.stddevs.conservativeResize(Eigen::NoChange, count);
    stated.starts.conservativeResize(count);
    stated.means.rightCols(1) = estimate.mean.head(p);
    stated.stddevs.rightCols(1) = estimate.stddev.head(p);
    stated.starts[count - 1] = window.start;
  }
  return stated;
}

/// About the parameter's course, where there are enough for one.
ScatterEstimate calcScatter(const Stated& stated, Index parameter, double level) {
  VectorXd values = stated.means.row(parameter);
  const VectorXd stddevs = stated.stddevs.row(parameter);
  const bool increase = std::adjacent_find(stated.starts.begin(), stated.starts.end(),
                                           std::greater_equal<>()) == stated.starts.end();
  if (values.size() >= kFewestOfCourse && increase) {
    const VectorXd fitted = fitCourse(values, stddevs, stated.starts, level).fitted;
    values += VectorXd::Constant(fitted.size(), fitted.mean()) - fitted;
  }
  return combineScattered(values, stddevs);
}

}  // namespace

void compareWindows(const std::vector<ParameterSpec>& parameters, std::vector<InferredMeasurement>& windows) {
  const auto p = static_cast<Index>(parameters.size());
  const Stated stated = collectStated(windows, p);
  if (stated.windows.size() < 2) {
    return;
  }
  const double level = kMismatchLevel / static_cast<double>(p);
  std::vector<ScatterEstimate> scatter;
  for (Index i = 0; i < p; ++i) {
    scatter.push_back(calcScatter(stated, i, level));
    scatter.back().bounds = parameters[static_cast<std::size_t>(i)].bounds;
  }
  const bool disagree = std::any_of(scatter.begin(), scatter.end(), [&](const ScatterEstimate& one) {
    return calcScatterPValue(one) < level;
  });
  for (InferredMeasurement* window : disagree ? stated.windows : std::vector<InferredMeasurement*>()) {
    window->scatter = scatter;
    window->asked.starts.assign(stated.starts.begin(), stated.starts.end());
  }
}

}  // namespace twinmap
