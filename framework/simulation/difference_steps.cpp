#include "framework/simulation/difference_steps.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/stencil.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLargestStep = 0.05;  // of the width: beyond it third derivatives are not those of the point
constexpr double kProbe = 0.125;       // of the width: the distance of the points of third derivatives

bool haveSucceeded(const std::vector<SampleStatus>& statuses) {
  return std::all_of(statuses.begin(), statuses.end(), [](const SampleStatus& status) { return status.ok; });
}

/// Root mean square of each output over the times.
VectorXd calcScales(const ResponseLayout& layout, const VectorXd& response) {
  VectorXd scales(layout.getOutputCount());
  for (Index i = 0; i < scales.size(); ++i) {
    scales[i] = std::sqrt(response.segment(layout.getRow(i, 0), layout.times.size()).squaredNorm() /
                          static_cast<double>(std::max<Index>(layout.times.size(), 1)));
  }
  return scales;
}

/// Root mean square over the outputs of values / scales; outputs that are 0 say nothing.
double calcRelative(const VectorXd& values, const VectorXd& scales) {
  const auto moves = scales.array() > 0.0;
  const auto count = static_cast<double>(std::max<Index>(moves.count(), 1));
  return std::sqrt(moves.select(values.array() / scales.array(), 0.0).square().sum() / count);
}

/// Of each output. Fourth differences of independent errors have 1 + 16 + 36 + 16 + 1 = 70 times their
/// variance. The median of the size of a normal variable is 0.6745 of its standard deviation.
VectorXd calcNoise(const ResponseLayout& layout, const MatrixXd& line) {
  MatrixXd differences = line;
  for (int order = 0; order < 4; ++order) {
    const Index count = differences.cols() - 1;
    differences = (differences.rightCols(count) - differences.leftCols(count)).eval();
  }
  VectorXd noise(layout.getOutputCount());
  for (Index i = 0; i < noise.size(); ++i) {
    const MatrixXd own = differences.middleRows(layout.getRow(i, 0), layout.times.size()).cwiseAbs();
    noise[i] = calcMedian(own.reshaped()) / (0.6745 * std::sqrt(70.0));
  }
  return noise;
}

MatrixXd makeLine(const VectorXd& center, const VectorXd& widths) {
  constexpr Index kPoints = 9;
  MatrixXd points = center.replicate(1, kPoints);
  for (Index i = 0; i < kPoints; ++i) {
    points.col(i) += static_cast<double>(i) * kSharedStepsDifference * widths;
  }
  return points;
}

/// The centre, then for each parameter two points on each side.
MatrixXd makeProbes(const VectorXd& center, const VectorXd& widths) {
  MatrixXd points = center.replicate(1, 1 + 4 * center.size());
  for (Index j = 0; j < center.size(); ++j) {
    for (Index i = 0; i < 4; ++i) {
      constexpr double kPositions[] = {-2.0, -1.0, 1.0, 2.0};
      points(j, 1 + 4 * j + i) += kPositions[i] * kProbe * widths[j];
    }
  }
  return points;
}

/// Per width^3.
VectorXd calcThirdDerivative(const MatrixXd& probes, Index parameter) {
  const auto at = [&](Index i) { return probes.col(1 + 4 * parameter + i); };
  return (at(3) - 2.0 * at(2) + 2.0 * at(1) - at(0)) / (2.0 * kProbe * kProbe * kProbe);
}

/// The parameters in which any column differs from the first.
std::vector<Index> collectMoved(const Eigen::Ref<const MatrixXd>& points) {
  std::vector<Index> moved;
  for (Index j = 0; j < points.rows(); ++j) {
    if ((points.row(j).array() != points(j, 0)).any()) {
      moved.push_back(j);
    }
  }
  return moved;
}

}  // namespace

bool DifferenceSteps::areShared() const {
  return (steps.array() == kSharedStepsDifference).all();
}

DifferenceSteps measureDifferenceSteps(const std::vector<ParameterSpec>& sampled,
                                       const ResponseLayout& layout, const SimulateNeighbours& simulate) {
  const VectorXd center = calcBoxCenter(sampled), widths = calcWidths(sampled);
  DifferenceSteps result{0.0, VectorXd::Constant(center.size(), kSharedStepsDifference)};
  const auto run = [&](const MatrixXd& points, MatrixXd& responses) {
    std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
    responses.resize(layout.getRowCount(), points.cols());
    simulate(points, responses, statuses);
    return haveSucceeded(statuses);
  };
  MatrixXd line, probes;
  if (!run(makeLine(center, widths), line)) {
    return result;
  }
  const VectorXd scales = calcScales(layout, line.col(0));
  result.noise = calcRelative(calcNoise(layout, line), scales);
  if (!run(makeProbes(center, widths), probes)) {
    return result;
  }
  for (Index j = 0; j < center.size(); ++j) {
    const double third = calcRelative(calcScales(layout, calcThirdDerivative(probes, j)), scales);
    const double best = std::cbrt(3.0 * result.noise / third);
    result.steps[j] =
        std::isnan(best) ? kSharedStepsDifference : std::clamp(best, kSharedStepsDifference, kLargestStep);
  }
  return result;
}

std::string describe(const DifferenceSteps& differences) {
  std::ostringstream text;
  text.precision(2);
  text << "noise of the solver " << differences.noise << " of the outputs";
  if (differences.steps.size() > 0) {
    const double least = differences.steps.minCoeff(), most = differences.steps.maxCoeff();
    text << ": differences over " << least;
    if (most > least) {
      text << " to " << most;
    }
    text << " of the bounds";
  }
  return text.str();
}

void simulateOnTangent(const std::vector<ParameterSpec>& sampled, const DifferenceSteps& differences,
                       const SimulateNeighbours& simulate, const Eigen::Ref<const MatrixXd>& points,
                       Eigen::Ref<MatrixXd> responses, SampleStatus* statuses) {
  const std::vector<Index> moved = collectMoved(points);
  const MatrixXd neighbours = makeNeighbours(sampled, points.col(0), differences.steps);
  MatrixXd stencil = points.col(0).replicate(1, 1 + 2 * static_cast<Index>(moved.size()));
  for (std::size_t k = 0; k < moved.size(); ++k) {
    stencil.middleCols(1 + 2 * static_cast<Index>(k), 2) = neighbours.middleCols(1 + 2 * moved[k], 2);
  }
  MatrixXd found(responses.rows(), stencil.cols());
  std::vector<SampleStatus> found_statuses(static_cast<std::size_t>(stencil.cols()));
  simulate(stencil, found, found_statuses);
  responses.colwise() = found.col(0);
  std::fill(statuses, statuses + points.cols(), found_statuses[0]);
  for (std::size_t k = 0; k < moved.size(); ++k) {
    const Index j = moved[k];
    const Bounds& bounds = sampled[static_cast<std::size_t>(j)].bounds;
    const VectorXd slope = calcDifference(found.col(0), found.middleCols(1 + 2 * static_cast<Index>(k), 2),
                                          bounds, points(j, 0), differences.steps[j]) /
                           (bounds.upper - bounds.lower);
    for (Index i = 0; i < points.cols(); ++i) {
      const double distance = points(j, i) - points(j, 0);
      if (std::abs(distance) > 0.0 && statuses[i].ok) {
        responses.col(i) += distance * slope;
        statuses[i] = found_statuses[2 * k + 1].ok ? found_statuses[2 * k + 2] : found_statuses[2 * k + 1];
      }
    }
  }
}

}  // namespace twinmap
