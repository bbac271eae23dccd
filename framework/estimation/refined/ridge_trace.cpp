#include "framework/estimation/refined/ridge_trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "framework/estimation/derived/value_distribution.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr std::size_t kMostPieces = 192;  // pieces, and those under way

Index countFlat(const LocalMisfit& minimum) {
  return (linalg::calcSymmetricEigenvalues(minimum.calcInformationWithin()).array() < kFlatInformation)
      .count();
}

/// One piece of a ridge.
struct RidgePiece {
  LocalMisfit local;
  VectorXd tangent;     ///< s: the way of one unit of the flat coordinate
  MatrixXd covariance;  ///< s x s, across the ridge
  double from, to;      ///< of the tangent, the part of the piece that is within the box
  double log_height;    ///< Laplace's approximation across
  double log_weight;    ///< of the piece within the box
};

/// Between two points of a straight ridge; share 0 is the first.
LocalMisfit blend(const LocalMisfit& first, const LocalMisfit& second, double share) {
  const auto mix = [share](const auto& a, const auto& b) { return (a + share * (b - a)).eval(); };
  LocalMisfit between = first;
  between.at = mix(first.at, second.at);
  between.chi_square += share * (second.chi_square - first.chi_square);
  between.information = mix(first.information, second.information);
  between.descent = mix(first.descent, second.descent);
  between.beside.misfit += share * (second.beside.misfit - first.beside.misfit);
  if (between.beside.descent.size() > 0) {
    between.beside.descent = mix(first.beside.descent, second.beside.descent);
    between.beside.information = mix(first.beside.information, second.beside.information);
  }
  return between;
}

class RidgeWalk {
 public:
  RidgeWalk(Misfit& misfit, const LocalMisfit& minimum) : misfit_(misfit) {
    const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(minimum.calcInformationWithin());
    along_ = eigen.vectors.col(0);
    across_ = eigen.vectors.rightCols(eigen.vectors.cols() - 1);
    constexpr double kPieces = 16.0, kFar = 10.0;
    const SearchBox& box = misfit.getBox();
    const double length = box.calcReach(minimum.at, along_, kFar) + box.calcReach(minimum.at, -along_, kFar);
    step_ = length / kPieces;
  }

  /// Whether it reached the ends.
  bool run(const LocalMisfit& minimum) {
    if (!(step_ > 0.0)) {
      return false;
    }
    const AcrossStep step = calcStep(minimum);
    const std::optional<LocalMisfit> middle =
        step.isSettled() ? std::optional(minimum) : settleAll(step.end).front();
    if (!middle || !add(*middle)) {
      return false;  // the minimum lies beyond the bounds
    }
    return crossStraight() || (walk(step_) && walk(-step_));
  }

  const std::vector<RidgePiece>& getPieces() const { return pieces_; }

 private:
  /// A Gauss-Newton step across the ridge.
  struct AcrossStep {
    VectorXd end;   ///< where it leads to
    double length;  ///< standard deviations

    bool isSettled() const { return length < kImmaterial; }
  };

  /// All pieces of a ridge that is straight between its ends, as that of a sum is: the middle, both ends and
  /// the points halfway are simulated, the others interpolated. False, and the middle alone, where it bends
  /// or its weight changes.
  bool crossStraight() {
    const RidgePiece middle = pieces_.front();
    const std::array<Index, 2> counts{countWithin(middle, step_), countWithin(middle, -step_)};
    const std::array<Index, 4> places{counts[0] / 2, counts[0], -(counts[1] / 2), -counts[1]};
    MatrixXd points(middle.tangent.size(), 4);
    for (std::size_t k = 0; k < places.size(); ++k) {
      points.col(static_cast<Index>(k)) =
          middle.local.at + static_cast<double>(places[k]) * step_ * middle.tangent;
    }
    const std::vector<LocalMisfit> found = misfit_.linearizeAll(points);
    for (const LocalMisfit& local : found) {
      if (!local.status.ok || !continuesStraight(middle, local)) {
        return false;
      }
    }
    for (const std::size_t side : {0, 1}) {
      const LocalMisfit &halfway = found[2 * side], &end = found[2 * side + 1];
      const Index half = counts[side] / 2, rest = counts[side] - half;
      for (Index i = 1; i <= half; ++i) {
        add(blend(middle.local, halfway, static_cast<double>(i) / static_cast<double>(half)));
      }
      for (Index i = 1; i <= rest; ++i) {
        add(blend(halfway, end, static_cast<double>(i) / static_cast<double>(rest)));
      }
    }
    return true;
  }

  /// Pieces beyond this one within the bounds and the search's limits, if the ridge goes straight on.
  Index countWithin(const RidgePiece& middle, double step) const {
    const auto most = static_cast<Index>(kMostPieces / 2);  // on either side
    RidgePiece piece = middle;
    for (Index i = 0; i < most; ++i) {
      piece.local.at += step * piece.tangent;
      if (misfit_.getBox().clamp(piece.local.at) != piece.local.at || !cutAtBounds(piece)) {
        return i;
      }
    }
    return most;
  }

  /// Whether the ridge passes through `end` in the same direction with about the same weight.
  bool continuesStraight(const RidgePiece& middle, const LocalMisfit& end) const {
    constexpr double kAlike = 0.2;  // log weight: linear between, it is wrong by some hundredths at most
    const Section section = calcSection(end);
    if (!section.factor.positive_definite || !calcStep(end).isSettled()) {
      return false;
    }
    const VectorXd turned = across_.transpose() * (middle.tangent - section.tangent);
    const double way = (end.at - middle.local.at).dot(along_);
    return std::abs(way) * std::sqrt(turned.dot(section.information * turned)) < kImmaterial &&
           std::abs(section.log_height - middle.log_height) < kAlike;
  }

  /// Piece by piece from the first, several at a time, all on the tangent of the last: samples that are
  /// simulated together cost little more than one. Where the ridge bends too much for that, the next ones
  /// start from the last that settled.
  bool walk(double step) {
    RidgePiece last = pieces_.front();
    while (pieces_.size() < kMostPieces) {
      const MatrixXd ahead = lookAhead(last, step);
      if (ahead.cols() == 0) {
        return true;  // the limits of the search stop it
      }
      const std::vector<std::optional<LocalMisfit>> settled = settleAll(ahead);
      if (!settled.front()) {
        return ahead.col(0).cwiseAbs().maxCoeff() > 1.0;  // beyond the bounds it need not go on
      }
      for (std::size_t i = 0; i < settled.size() && settled[i]; ++i) {
        if (!add(*settled[i]) || pieces_.back().log_weight < pieces_.front().log_weight - 0.5 * kBasinAbove) {
          return true;
        }
      }
      last = pieces_.back();
    }
    return false;
  }

  /// Points of the next pieces, as many as the limits of the search leave.
  MatrixXd lookAhead(const RidgePiece& last, double step) const {
    constexpr Index kAhead = 8;  // half of the ridge; and as many lanes
    MatrixXd points(last.tangent.size(), kAhead);
    VectorXd before = last.local.at;
    Index count = 0;
    for (; count < kAhead; ++count) {
      const VectorXd next = misfit_.getBox().clamp(before + step * last.tangent);
      if ((next - before).dot(along_) / step < 0.5) {
        break;
      }
      points.col(count) = before = next;
    }
    return points.leftCols(count);
  }

  AcrossStep calcStep(const LocalMisfit& local) const {
    const MatrixXd information = across_.transpose() * local.calcInformationWithin() * across_;
    const VectorXd descent = across_.transpose() * local.calcDescentWithin();
    const VectorXd step = linalg::solvePositiveDefinite(information, descent);
    return {misfit_.getBox().clamp(local.at + across_ * step), std::sqrt(step.dot(information * step))};
  }

  /// Steps across the ridge from each point until they are small; nothing where they do not become so or a
  /// simulation fails.
  std::vector<std::optional<LocalMisfit>> settleAll(MatrixXd points) {
    std::vector<std::optional<LocalMisfit>> settled(static_cast<std::size_t>(points.cols()));
    std::vector<Index> open = listIndices(points.cols());
    for (int k = 0; k < kFewIterations && !open.empty(); ++k) {
      const std::vector<LocalMisfit> found = misfit_.linearizeAll(points(Eigen::all, open));
      std::vector<Index> left;
      for (std::size_t i = 0; i < open.size(); ++i) {
        if (!found[i].status.ok) {
          continue;
        }
        const AcrossStep step = calcStep(found[i]);
        if (step.isSettled()) {
          settled[static_cast<std::size_t>(open[i])] = found[i];
        } else {
          points.col(open[i]) = step.end;
          left.push_back(open[i]);
        }
      }
      open = std::move(left);
    }
    return settled;
  }

  /// The ridge's section at a point.
  struct Section {
    MatrixXd information;  ///< across
    linalg::Cholesky factor;
    VectorXd tangent;
    double log_height;
  };

  Section calcSection(const LocalMisfit& local) const {
    const MatrixXd whole = local.calcInformationWithin();
    const MatrixXd information = across_.transpose() * whole * across_;
    const linalg::Cholesky factor = linalg::calcCholesky(information);
    const VectorXd coupling = across_.transpose() * whole * along_;
    return {information, factor, along_ - across_ * linalg::solveCholesky(factor.lower, coupling),
            -0.5 * local.calcMisfitWithin() - factor.lower.diagonal().array().log().sum()};
  }

  /// Whether any of the piece there is within the box.
  bool add(const LocalMisfit& local) {
    const Section section = calcSection(local);
    const MatrixXd covariance =
        across_ * linalg::invertPositiveDefinite(section.information) * across_.transpose();
    RidgePiece piece{local, section.tangent, covariance, 0.0, 0.0, section.log_height, 0.0};
    if (!cutAtBounds(piece)) {
      return false;
    }
    piece.log_weight = piece.log_height + std::log(piece.to - piece.from) + calcLogWithin(piece);
    pieces_.push_back(piece);
    return true;
  }

  /// The part of half a step on both sides that may be within the bounds, given the standard deviations
  /// across the ridge.
  bool cutAtBounds(RidgePiece& piece) const {
    piece.from = -0.5 * step_;
    piece.to = 0.5 * step_;
    for (Index j = 0; j < piece.tangent.size(); ++j) {
      const double slope = piece.tangent[j], at = piece.local.at[j];
      const double limit = 1.0 + kBasinReach * std::sqrt(piece.covariance(j, j));
      if (std::abs(slope) < 1e-12) {
        if (std::abs(at) > limit) {
          return false;
        }
        continue;
      }
      const double first = (-limit - at) / slope, second = (limit - at) / slope;
      piece.from = std::max(piece.from, std::min(first, second));
      piece.to = std::min(piece.to, std::max(first, second));
    }
    return piece.to > piece.from;
  }

  /// The probability of being within the bounds at the middle of a piece, parameter by parameter.
  static double calcLogWithin(const RidgePiece& piece) {
    const VectorXd middle = piece.local.at + 0.5 * (piece.from + piece.to) * piece.tangent;
    double sum = 0.0;
    for (Index j = 0; j < middle.size(); ++j) {
      const double scale = std::sqrt(2.0 * piece.covariance(j, j));
      sum += std::log(0.5 * (std::erfc((middle[j] - 1.0) / scale) - std::erfc((middle[j] + 1.0) / scale)));
    }
    return sum;
  }

  Misfit& misfit_;
  VectorXd along_;
  MatrixXd across_;
  double step_;
  std::vector<RidgePiece> pieces_;
};

VectorXd calcWeights(const std::vector<RidgePiece>& pieces) {
  VectorXd weights(static_cast<Index>(pieces.size()));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    weights[static_cast<Index>(i)] = pieces[i].log_weight;
  }
  weights = (weights.array() - weights.maxCoeff()).exp();
  return weights / weights.sum();
}

/// Each piece as a normal distribution of its own mean and covariance: uniform along, normal across.
Mixture makePieces(const std::vector<RidgePiece>& pieces) {
  const Index s = pieces.front().tangent.size(), count = static_cast<Index>(pieces.size());
  Mixture mixture{calcWeights(pieces), MatrixXd(s, count), MatrixXd(s, count), {}};
  for (Index i = 0; i < count; ++i) {
    const RidgePiece& piece = pieces[static_cast<std::size_t>(i)];
    const double spread = (piece.to - piece.from) * kUniformStddev;
    const MatrixXd covariance =
        piece.covariance + spread * spread * piece.tangent * piece.tangent.transpose();
    mixture.means.col(i) = piece.local.at;  // the middle of a cut piece would lie beside a bent ridge
    mixture.stddevs.col(i) = covariance.diagonal().cwiseSqrt();
    mixture.correlations.push_back(calcCorrelation(covariance));
  }
  return mixture;
}

/// How far intervals of one parameter reach, in its standard deviations: quantiles of the distance from the
/// mean over ten places of each piece, with 25 of the normal distribution across.
IntervalFactor calcFactor(const std::vector<RidgePiece>& pieces, const VectorXd& weights, Index j,
                          double mean, double stddev) {
  constexpr Index kPlaces = 10, kAcross = 25;
  const Index count = static_cast<Index>(pieces.size()) * kPlaces * kAcross;
  VectorXd distances(count), shares(count);
  Index k = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const RidgePiece& piece = pieces[i];
    const double across = std::sqrt(piece.covariance(j, j));
    for (Index place = 0; place < kPlaces; ++place) {
      const double along =
          piece.from + (piece.to - piece.from) * (static_cast<double>(place) + 0.5) / kPlaces;
      for (const double z : VectorXd::LinSpaced(kAcross, -kBasinReach, kBasinReach)) {
        distances[k] = std::abs(piece.local.at[j] + along * piece.tangent[j] + z * across - mean) / stddev;
        shares[k++] = weights[static_cast<Index>(i)] * std::exp(-0.5 * z * z);
      }
    }
  }
  const ValueDistribution distribution(distances, shares);
  return {distribution.calcQuantile(0.5), distribution.calcQuantile(0.95)};
}

RidgeTrace summarize(const std::vector<RidgePiece>& pieces) {
  RidgeTrace trace{makePieces(pieces), {}, {}, {}};
  const MatrixXd covariance = calcCovariance(trace.pieces);
  const Index s = covariance.rows();
  trace.mean = calcMean(trace.pieces);
  trace.stddev = covariance.diagonal().cwiseSqrt();
  trace.factors = {MatrixXd::Constant(s, 1, kNormal50), MatrixXd::Constant(s, 1, kNormal95)};
  for (Index j = 0; j < s; ++j) {
    const VectorXd moved = trace.pieces.means.row(j).transpose().array() - trace.mean[j];
    if (moved.cwiseAbs().maxCoeff() > kImmaterial * trace.stddev[j]) {
      trace.factors.set(j, 0, calcFactor(pieces, trace.pieces.weights, j, trace.mean[j], trace.stddev[j]));
    }
  }
  return trace;
}

}  // namespace

bool hasFlatDirection(const LocalMisfit& minimum) {
  return countFlat(minimum) == 1 && minimum.information.rows() > 1;
}

std::optional<RidgeTrace> traceRidge(Misfit& misfit, const LocalMisfit& minimum) {
  if (!hasFlatDirection(minimum)) {
    return std::nullopt;
  }
  RidgeWalk walk(misfit, minimum);
  if (!walk.run(minimum)) {
    return std::nullopt;
  }
  return summarize(walk.getPieces());
}

}  // namespace twinmap
