#include "framework/inference/clock/clock_search.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/noise/residual_test.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/clock/clocked_fit.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Where a slip would take most of the misfit away.
struct SlipPlace {
  double from = 0.0, gain = 0.0;
};

MatrixXd calcInformation(const MatrixXd& jacobian) {
  const MatrixXd information = jacobian.transpose() * jacobian;
  return information + MatrixXd(kRegular * information.diagonal().asDiagonal()) +
         std::numeric_limits<double>::min() * MatrixXd::Identity(information.rows(), information.cols());
}

/// Scans all stamps: late: the derivative of the residual by a delay, less what `jacobian` explains.
/// O(n u^2).
SlipPlace scanSlips(const VectorXd& residual, const MatrixXd& jacobian, const VectorXd& late,
                    const std::vector<FeatureInfo>& infos) {
  const MatrixXd lower = linalg::calcCholesky(calcInformation(jacobian)).lower;
  const VectorXd left = residual - jacobian * linalg::solveCholesky(lower, jacobian.transpose() * residual);
  const auto get_time = [&](Index i) { return infos[static_cast<std::size_t>(i)].time; };
  const std::vector<Index> order =
      sortIndices(late.size(), [&](Index a, Index b) { return get_time(a) > get_time(b); });
  SlipPlace best;
  double slope = 0.0, squares = 0.0;
  VectorXd shared = VectorXd::Zero(jacobian.cols());
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    const Index i = order[k];
    slope += late[i] * left[i];
    squares += late[i] * late[i];
    shared += late[i] * jacobian.row(i).transpose();
    if (get_time(order[k + 1]) < get_time(i)) {
      const double own = squares - linalg::solveLower(lower, shared).squaredNorm();
      // else the parameters explain it
      const double gain = own > kSameNumber * squares ? slope * slope / own : 0.0;
      best = gain > best.gain ? SlipPlace{get_time(i), gain} : best;
    }
  }
  return best;
}

class ClockSearch {
 public:
  explicit ClockSearch(const RecordedSamples& recorded)
      : recorded_(recorded),
        is_unknown_(std::any_of(recorded.noise.outputs.begin(), recorded.noise.outputs.end(),
                                [](const OutputNoise& noise) { return !noise.factor; })) {}

  /// The fit with the fewest faults that leaves noise; not given where none does.
  ClockedFit find(const VectorXd& best) const {
    const NuisanceSize late{"late"}, rate{"rate"};
    ClockedFit slips = addSlip(linearizeClocked(recorded_, best, {}));
    ClockedFit simplest;
    for (ClockedFit fit : {fitClock(recorded_, best, {late}), fitClock(recorded_, best, {rate}), slips}) {
      if (isNoise(fit) && (!simplest.isGiven() || calcCost(fit) < calcCost(simplest))) {
        simplest = std::move(fit);
      }
    }
    if (simplest.isGiven()) {
      return simplest;
    }
    if (const ClockedFit both = fitClock(recorded_, best, {late, rate}); isNoise(both)) {
      return both;
    }
    for (double before = slips.misfit; slips.isGiven() && !isNoise(slips); before = slips.misfit) {
      slips = addSlip(slips);
      if (!mayExplain(slips, before)) {
        return {};
      }
    }
    return slips;
  }

  /// Standard deviations of the faults' sizes.
  VectorXd calcStddevs(const ClockedFit& fit) const {
    const Index u = fit.point.size(), k = static_cast<Index>(fit.faults.size());
    const MatrixXd lower = linalg::calcCholesky(calcInformation(fit.jacobian)).lower;
    const MatrixXd covariance = linalg::solveCholesky(lower, MatrixXd::Identity(u + k, u + k));
    const double variance = is_unknown_ ? fit.residual.squaredNorm() / fit.calcDegrees() : 1.0;
    return (variance * covariance.diagonal().tail(k)).cwiseSqrt();
  }

 private:
  /// The residual with the size of unknown noise taken off.
  VectorXd scale(const ClockedFit& fit) const {
    VectorXd scaled = fit.residual;
    for (const OutputNoise& noise : recorded_.noise.outputs) {
      std::vector<Index> rows;
      for (std::size_t i = 0; i < fit.infos.size() && !noise.factor; ++i) {
        if (fit.infos[i].output == noise.output) {
          rows.push_back(static_cast<Index>(i));
        }
      }
      if (!rows.empty()) {
        const VectorXd own = scaled(rows);
        const double size = std::sqrt(own.squaredNorm() / static_cast<double>(rows.size()));
        scaled(rows) = own / std::max(size, std::numeric_limits<double>::min());
      }
    }
    return scaled;
  }

  bool isNoise(const ClockedFit& fit) const {
    return fit.isGiven() && testResidual(scale(fit), fit.calcDegrees(), fit.infos).isPlausible();
  }

  /// Chi-square, and for a slip that it may be anywhere.
  double calcCost(const ClockedFit& fit) const {
    const bool is_slip = fit.faults.front().from.has_value();
    return scale(fit).squaredNorm() +
           (is_slip ? 2.0 * std::log(static_cast<double>(fit.residual.size())) : 0.0);
  }

  double countMost(const ClockedFit& fit) const {
    constexpr double kMost = 40.0;
    return std::min(kMost, static_cast<double>(fit.residual.size()) / static_cast<double>(kFewestTested));
  }

  /// Whether noise could be left if each slip that may follow took the share that the last one took. The
  /// first take most.
  bool mayExplain(const ClockedFit& fit, double before) const {
    const double left = countMost(fit) - static_cast<double>(fit.faults.size());
    return !fit.isGiven() || is_unknown_ ||
           fit.misfit * std::pow(fit.misfit / before, left) < calcChiSquareLimit(fit.calcDegrees());
  }

  /// Of the residual, by a delay of the whole recording; empty where that cannot be simulated.
  VectorXd calcLateDerivative(const ClockedFit& fit) const {
    std::vector<NuisanceSize> faults = fit.faults;
    faults.push_back({"late"});
    const ClockedFit with = linearizeClocked(recorded_, fit.point, faults);
    const bool is_same = with.isGiven() && with.residual.size() == fit.residual.size();
    return is_same ? VectorXd(with.jacobian.rightCols(1)) : VectorXd();
  }

  /// With one slip more, at the best place; not given where none is worth it.
  ClockedFit addSlip(const ClockedFit& fit) const {
    const auto n = static_cast<double>(fit.residual.size());
    if (!fit.isGiven() || !recorded_.experiment.noise.correlation.empty() ||
        static_cast<double>(fit.faults.size()) >= countMost(fit)) {
      return {};
    }
    const VectorXd late = calcLateDerivative(fit);
    if (late.size() == 0) {
      return {};
    }
    const SlipPlace place = scanSlips(fit.residual, fit.jacobian, late, fit.infos);
    const double left = fit.residual.squaredNorm() - place.gain;
    const double variance = is_unknown_ ? left / fit.calcDegrees() : 1.0;
    if (place.gain < 2.0 * std::log(n / kRareLevel) * variance) {
      return {};
    }
    std::vector<NuisanceSize> faults = fit.faults;
    faults.push_back({"late", 0.0, 0.0, place.from});
    return placeAnew(fitClock(recorded_, fit.point, faults));
  }

  /// With each slip where it takes most away, beside the others.
  ClockedFit placeAnew(ClockedFit fit) const {
    if (!fit.isGiven()) {
      return fit;
    }
    const VectorXd late = calcLateDerivative(fit);
    if (late.size() == 0) {
      return fit;
    }
    std::vector<NuisanceSize> faults = fit.faults;
    bool moved = false;
    for (std::size_t k = 0; k < fit.faults.size(); ++k) {
      const Index column = fit.point.size() + static_cast<Index>(k);
      MatrixXd others = fit.jacobian;
      others.col(column).setZero();
      const VectorXd without = fit.residual + fit.jacobian.col(column) * fit.faults[k].value;
      const double from = scanSlips(without, others, late, fit.infos).from;
      moved = moved || from != fit.faults[k].from;
      faults[k].from = from;
    }
    if (!moved) {
      return fit;
    }
    ClockedFit next = fitClock(recorded_, fit.point, faults);
    return next.isGiven() && next.misfit < fit.misfit ? next : fit;
  }

  const RecordedSamples& recorded_;
  const bool is_unknown_;  // the size of noise
};

}  // namespace

std::optional<NuisanceFit> findClockFaults(const RecordedSamples& recorded, const VectorXd& best) {
  constexpr double kReach = 10.0;  // standard deviations: no bound of the posterior's
  const ClockSearch search(recorded);
  const ClockedFit fit = search.find(best);
  if (!fit.isGiven()) {
    return std::nullopt;
  }
  return NuisanceFit{makeClockedSimulator(recorded, fit.faults, kReach * search.calcStddevs(fit)),
                     takeWithin(recorded, fit.faults),
                     appendSizes(fit.point, fit.faults),
                     {Notice::kClockFault, "clock", {"delay.", "clock."}, fit.faults},
                     describeClock};
}

}  // namespace twinmap
