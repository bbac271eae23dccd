#include "framework/inference/segments/segmented_misfit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/log/search_stage.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Segments simulated at once: enough to keep lanes busy, and their derivatives take some ten megabytes.
constexpr Index kBatch = 256;

/// Points whose states are remembered: as many as searches have at once, in at most 200 MB.
std::size_t countAnchors(const SegmentedRecording& recording) {
  constexpr double kMost = 64.0, kFewest = 4.0, kNumbers = 25e6;
  const auto numbers = static_cast<double>(recording.features.size() * recording.scales.size());
  return static_cast<std::size_t>(std::clamp(kNumbers / numbers, kFewest, kMost));
}

VectorXd makeHeld(const SegmentedRecording& recording) {
  const auto u = static_cast<Index>(recording.unknown.size());
  VectorXd held(u + recording.scales.size() + recording.known.size() + 1);
  held << calcBoxCenter(recording.unknown), VectorXd::Zero(recording.scales.size()), recording.known, 0.0;
  return held;
}

}  // namespace

SegmentedMisfit::SegmentedMisfit(Simulator& simulator, const SegmentedRecording& recording)
    : simulator_(simulator),
      recording_(recording),
      box_(recording.unknown, {0, static_cast<Index>(recording.unknown.size())}, makeHeld(recording)),
      precision_((kStateScales * recording.scales).cwiseInverse()),
      samples_(recording.features.array().isFinite().count()),
      kept_(countAnchors(recording)) {}

const SegmentedMisfit::Anchor* SegmentedMisfit::findNearest(const VectorXd& at) const {
  const auto nearest = std::min_element(
      anchors_.begin(), anchors_.end(),
      [&](const Anchor& a, const Anchor& b) { return (at - a.at).norm() < (at - b.at).norm(); });
  return nearest == anchors_.end() ? nullptr : &*nearest;
}

/// Of the first point all segments, then of the second ...; each where the linear model of the nearest point
/// before says, at first where the recording says.
std::vector<SegmentedMisfit::SegmentFit> SegmentedMisfit::begin(const MatrixXd& points) const {
  std::vector<SegmentFit> fits;
  for (Index i = 0; i < points.cols(); ++i) {
    const Anchor* const anchor = findNearest(points.col(i));
    for (Index k = 0; k < recording_.starts.size(); ++k) {
      SegmentFit fit;
      fit.point = i;
      fit.segment = k;
      fit.state = recording_.states.col(k);
      if (anchor != nullptr) {
        fit.near = &anchor->best[static_cast<std::size_t>(k)];
        fit.state = limit(fit.near->state + fit.near->slopes * (points.col(i) - anchor->at), k);
      }
      fits.push_back(std::move(fit));
    }
  }
  return fits;
}

void SegmentedMisfit::improve(const MatrixXd& points, bool with_derivatives, std::vector<SegmentFit>& fits) {
  for (int round = 0; round < kFewIterations; ++round) {
    std::vector<SegmentFit*> active;
    for (SegmentFit& fit : fits) {
      if (fit.active) {
        active.push_back(&fit);
      }
    }
    for (std::size_t first = 0; first < active.size(); first += kBatch) {
      const auto begin = active.begin() + static_cast<std::ptrdiff_t>(first);
      const std::size_t count = std::min<std::size_t>(kBatch, active.size() - first);
      simulate(points, with_derivatives, {begin, begin + static_cast<std::ptrdiff_t>(count)});
    }
  }
}

void SegmentedMisfit::simulate(const MatrixXd& points, bool with_derivatives,
                               const std::vector<SegmentFit*>& fits) {
  const Index u = points.rows(), s = recording_.scales.size(), count = static_cast<Index>(fits.size());
  MatrixXd sampled(u + s + recording_.known.size() + 1, count);
  for (Index i = 0; i < count; ++i) {
    const SegmentFit& fit = *fits[static_cast<std::size_t>(i)];
    sampled.col(i) = box_.makePoint(points.col(fit.point));
    sampled.col(i).segment(u, s) = fit.state;
    sampled(sampled.rows() - 1, i) = recording_.starts[fit.segment];
  }
  MatrixXd responses(simulator_.getLayout().getRowCount(), count), derivatives(responses.rows(), 0);
  std::vector<SampleStatus> statuses(fits.size());
  if (with_derivatives) {
    simulator_.simulateWithDerivatives(sampled, responses, derivatives, statuses.data());
  } else {
    simulator_.simulate(sampled, responses, statuses.data());
  }
  simulations_ += static_cast<int>(count);
  noteSimulations(count);
  for (Index i = 0; i < count; ++i) {
    SegmentFit& fit = *fits[static_cast<std::size_t>(i)];
    fit.status = statuses[static_cast<std::size_t>(i)];
    update(responses.col(i),
           with_derivatives ? MatrixXd(derivatives.middleCols(i * sampled.rows(), u + s)) : MatrixXd(), fit);
  }
}

/// The prior's mean of the state less the state.
VectorXd SegmentedMisfit::calcAhead(const SegmentFit& fit) const {
  return recording_.states.col(fit.segment) - fit.state;
}

/// Within a standard deviation of its prior, which is wide: where a linear model leads farther it holds no
/// longer, and a simulation from there can take for ever.
VectorXd SegmentedMisfit::limit(const VectorXd& state, Index segment) const {
  const VectorXd given = recording_.states.col(segment), reach = precision_.cwiseInverse();
  return state.cwiseMax(given - reach).cwiseMin(given + reach);
}

/// Takes what was simulated as the best so far, or goes back half the way. Samples that are missing count 0.
void SegmentedMisfit::update(const VectorXd& response, const MatrixXd& derivatives, SegmentFit& fit) const {
  if (!fit.status.ok) {
    retreat(fit);
    return;
  }
  const VectorXd measured = recording_.features.col(fit.segment);
  const auto is_there = measured.array().isFinite();
  const VectorXd difference = is_there.select(measured - recording_.extractor.extract(response), 0.0);
  const VectorXd residual = recording_.getWhitener(fit.segment).apply(difference)(recording_.order, 0);
  const double misfit = residual.squaredNorm() + precision_.cwiseProduct(calcAhead(fit)).squaredNorm();
  if (!std::isfinite(misfit) || (fit.accepted.size() > 0 && !(misfit < fit.misfit))) {
    retreat(fit);
    return;
  }
  fit.accepted = fit.state;
  fit.misfit = misfit;
  if (derivatives.size() == 0) {
    takeStep(residual, fit.near->by_state, fit);
  } else {
    MatrixXd slopes = recording_.extractor.extract(derivatives);
    slopes = is_there.replicate(1, slopes.cols()).select(slopes, 0.0);
    takeStep(residual, recording_.getWhitener(fit.segment).apply(slopes)(recording_.order, Eigen::all), fit);
  }
  fit.state = limit(fit.accepted + fit.local.step, fit.segment);
  // a thousand segments are then off by less than one in chi-square, however far from linear
  fit.active = fit.local.gain > kLastGain;
}

/// derivatives: whitened, by the parameters' units and the states (u + s), or by the states alone.
void SegmentedMisfit::takeStep(const VectorXd& residual, const MatrixXd& derivatives, SegmentFit& fit) const {
  const Index s = recording_.scales.size(), u = derivatives.cols() - s;
  if (u == 0) {
    const VectorXd descent =
        derivatives.transpose() * residual + precision_.cwiseAbs2().cwiseProduct(calcAhead(fit));
    fit.local.step = linalg::solveCholesky(fit.near->hessian, descent);
    fit.local.gain = descent.dot(fit.local.step);
    return;
  }
  fit.by_state = derivatives.rightCols(s);
  fit.local =
      eliminateState(residual, fit.by_state, derivatives.leftCols(u) * box_.getHalfWidths().asDiagonal(),
                     {precision_, calcAhead(fit)});
}

/// Half the way back to the best state so far, or, where there is none, to the one that was given.
void SegmentedMisfit::retreat(SegmentFit& fit) const {
  if (fit.accepted.size() > 0) {
    fit.state = 0.5 * (fit.state + fit.accepted);
  } else {
    const VectorXd given = recording_.states.col(fit.segment);
    fit.active = fit.state != given;
    fit.state = given;
  }
}

/// fits: of all segments at the point.
LocalMisfit SegmentedMisfit::combine(const VectorXd& at, const SegmentFit* fits) const {
  const Index u = at.size(), segments = recording_.starts.size(), rows = recording_.features.rows();
  LocalMisfit local{{}, at, 0.0, 0.0, samples_, MatrixXd::Zero(u, u), VectorXd::Zero(u), {}, {}};
  local.residual.resize(segments * rows);
  double told = 0.0;
  for (Index k = 0; k < segments; ++k) {
    if (fits[k].accepted.size() == 0) {
      return {fits[k].status, {}, 0.0, 0.0, 0, {}, {}, {}, {}};
    }
    const StateElimination& own = fits[k].local;
    local.information += own.jacobian.transpose() * own.jacobian;
    local.descent += own.jacobian.transpose() * own.residual;
    local.residual.segment(k * rows, rows) = own.residual;
    told += own.told;
  }
  local.residuals -= std::lround(told);
  local.chi_square = local.residual.squaredNorm();
  local.misfit = local.chi_square + kHalfWidthInformation * at.squaredNorm();
  local.descent -= kHalfWidthInformation * at;
  return local;
}

void SegmentedMisfit::remember(const VectorXd& at, SegmentFit* fits) {
  Anchor anchor{at, {}};
  for (Index k = 0; k < recording_.starts.size(); ++k) {
    SegmentFit& fit = fits[k];
    MatrixXd hessian = fit.by_state.transpose() * fit.by_state;
    hessian.diagonal() += precision_.cwiseAbs2();
    anchor.best.push_back({fit.accepted + fit.local.step, std::move(fit.local.slopes),
                           std::move(fit.by_state), linalg::calcCholesky(hessian).lower});
  }
  if (anchors_.size() < kept_) {
    anchors_.push_back(std::move(anchor));
  } else {
    anchors_[oldest_] = std::move(anchor);
    oldest_ = (oldest_ + 1) % kept_;
  }
}

template <class Action>
void SegmentedMisfit::fitEach(const MatrixXd& points, bool with_derivatives, Action action) {
  const Index segments = recording_.starts.size(), together = std::max<Index>(1, kBatch / segments);
  for (Index first = 0; first < points.cols(); first += together) {
    const Index count = std::min(together, points.cols() - first);
    std::vector<SegmentFit> fits = begin(points.middleCols(first, count));
    improve(points.middleCols(first, count), with_derivatives, fits);
    for (Index i = 0; i < count; ++i) {
      action(first + i, fits.data() + i * segments);
    }
  }
}

std::vector<LocalMisfit> SegmentedMisfit::linearizeAll(const MatrixXd& points) {
  std::vector<LocalMisfit> all;
  fitEach(points, true, [&](Index i, SegmentFit* fits) {
    all.push_back(combine(points.col(i), fits));
    if (all.back().status.ok) {
      remember(points.col(i), fits);
    }
  });
  return all;
}

MatrixXd SegmentedMisfit::findStates(const VectorXd& parameters) {
  const VectorXd at = box_.normalize(parameters);
  MatrixXd states(recording_.scales.size(), 0);
  if (!linearizeAll(at).front().status.ok) {
    return states;
  }
  const Anchor& anchor = *findNearest(at);
  states.resize(states.rows(), recording_.starts.size());
  for (Index k = 0; k < states.cols(); ++k) {
    states.col(k) = anchor.best[static_cast<std::size_t>(k)].state;
  }
  return states;
}

VectorXd SegmentedMisfit::evaluate(const MatrixXd& points) {
  VectorXd misfits = VectorXd::Constant(points.cols(), std::numeric_limits<double>::infinity());
  if (anchors_.empty()) {
    return misfits;  // nothing could be simulated
  }
  fitEach(points, false, [&](Index i, const SegmentFit* fits) {
    double sum = kHalfWidthInformation * points.col(i).squaredNorm();
    for (Index k = 0; k < recording_.starts.size(); ++k) {
      const SegmentFit& fit = fits[k];
      sum += fit.accepted.size() == 0 ? std::numeric_limits<double>::infinity() : fit.misfit - fit.local.gain;
    }
    misfits[i] = sum;
  });
  return misfits;
}

}  // namespace twinmap
