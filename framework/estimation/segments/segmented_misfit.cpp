#include "framework/estimation/segments/segmented_misfit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Rounds of Gauss and Newton's method; a point near others takes one.
constexpr int kMaxRounds = 8;
/// Of a segment's misfit: what a round may still gain. A thousand segments are then off by less than one in
/// chi-square even where the response is as far from linear as it can be.
constexpr double kLastGain = 0.01;
/// Segments simulated at once: enough to keep lanes busy, and their derivatives take some ten megabytes.
constexpr std::size_t kBatch = 256;
/// Points whose states are remembered.
constexpr std::size_t kAnchors = 64;

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
      prior_{(kStateScales * recording.scales).cwiseInverse(), VectorXd::Zero(recording.scales.size())} {}

/// By the linear model of the nearest point at which states are known; at first as they are given.
MatrixXd SegmentedMisfit::predictStates(const VectorXd& at) const {
  const auto nearest = std::min_element(
      anchors_.begin(), anchors_.end(),
      [&](const Anchor& a, const Anchor& b) { return (at - a.at).norm() < (at - b.at).norm(); });
  if (nearest == anchors_.end()) {
    return recording_.states;
  }
  MatrixXd states = nearest->states;
  for (Index k = 0; k < states.cols(); ++k) {
    states.col(k) += nearest->slopes[static_cast<std::size_t>(k)] * (at - nearest->at);
  }
  return states;
}

void SegmentedMisfit::simulate(const MatrixXd& points, const std::vector<SegmentFit*>& fits) {
  const auto u = points.rows(), s = recording_.scales.size();
  for (std::size_t first = 0; first < fits.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, fits.size() - first);
    MatrixXd sampled(u + s + recording_.known.size() + 1, static_cast<Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      const SegmentFit& fit = *fits[first + i];
      sampled.col(static_cast<Index>(i)) = box_.makePoint(points.col(fit.point));
      sampled.col(static_cast<Index>(i)).segment(u, s) = fit.state;
      sampled(sampled.rows() - 1, static_cast<Index>(i)) = recording_.starts[fit.segment];
    }
    MatrixXd responses(simulator_.getLayout().getRowCount(), sampled.cols()), derivatives;
    std::vector<SampleStatus> statuses(count);
    simulator_.simulateWithDerivatives(sampled, responses, derivatives, statuses.data());
    simulations_ += static_cast<int>(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto column = static_cast<Index>(i);
      fits[first + i]->status = statuses[i];
      update(responses.col(column), derivatives.middleCols(column * sampled.rows(), u + s), *fits[first + i]);
    }
  }
}

/// Takes what was simulated as the best so far, or goes back half the way.
void SegmentedMisfit::update(const VectorXd& response, const MatrixXd& derivatives, SegmentFit& fit) const {
  const Index u = static_cast<Index>(recording_.unknown.size()), s = recording_.scales.size();
  if (!fit.status.ok) {
    retreat(fit);
    return;
  }
  VectorXd difference = recording_.features.col(fit.segment) - recording_.extractor.extract(response);
  MatrixXd slopes = recording_.extractor.extract(derivatives);
  fit.residuals = 0;
  for (Index i = 0; i < difference.size(); ++i) {
    if (std::isfinite(difference[i])) {
      ++fit.residuals;
    } else {
      difference[i] = 0.0;
      slopes.row(i).setZero();
    }
  }
  slopes.leftCols(u) *= box_.getHalfWidths().asDiagonal();
  const VectorXd residual = recording_.whitener.apply(difference)(recording_.order, 0);
  const MatrixXd jacobian = recording_.whitener.apply(slopes)(recording_.order, Eigen::all);
  const VectorXd ahead = recording_.states.col(fit.segment) - fit.state;
  const double misfit = residual.squaredNorm() + prior_.precision.cwiseProduct(ahead).squaredNorm();
  if (!std::isfinite(misfit) || (fit.accepted.size() > 0 && !(misfit < fit.misfit))) {
    retreat(fit);
    return;
  }
  fit.accepted = fit.state;
  fit.misfit = misfit;
  fit.local =
      eliminateState(residual, jacobian.rightCols(s), jacobian.leftCols(u), {prior_.precision, ahead});
  fit.information = fit.local.jacobian.transpose() * fit.local.jacobian;
  fit.descent = fit.local.jacobian.transpose() * fit.local.residual;
  fit.local.jacobian.resize(0, 0);
  fit.state = fit.accepted + fit.local.step;
  fit.active = fit.local.gain > kLastGain;
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

/// Of the first point all segments, then of the second ...
std::vector<SegmentedMisfit::SegmentFit> SegmentedMisfit::fitAll(const MatrixXd& points) {
  const Index segments = recording_.starts.size();
  std::vector<SegmentFit> fits(static_cast<std::size_t>(points.cols() * segments));
  for (Index i = 0; i < points.cols(); ++i) {
    const MatrixXd states = predictStates(points.col(i));
    for (Index k = 0; k < segments; ++k) {
      SegmentFit& fit = fits[static_cast<std::size_t>(i * segments + k)];
      fit.point = i;
      fit.segment = k;
      fit.state = states.col(k);
    }
  }
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<SegmentFit*> active;
    for (SegmentFit& fit : fits) {
      if (fit.active) {
        active.push_back(&fit);
      }
    }
    if (active.empty()) {
      break;
    }
    simulate(points, active);
  }
  return fits;
}

/// fits: of all segments at the point.
LocalMisfit SegmentedMisfit::combine(const VectorXd& at, const SegmentFit* fits) const {
  const Index u = at.size(), segments = recording_.starts.size(), rows = recording_.features.rows();
  LocalMisfit local{{}, at, 0.0, 0.0, 0, MatrixXd::Zero(u, u), VectorXd::Zero(u), {}, {}};
  local.residual.resize(segments * rows);
  double told = 0.0;
  for (Index k = 0; k < segments; ++k) {
    const SegmentFit& fit = fits[k];
    if (fit.accepted.size() == 0) {
      return {fit.status, {}, 0.0, 0.0, 0, {}, {}, {}, {}};
    }
    local.information += fit.information;
    local.descent += fit.descent;
    local.residual.segment(k * rows, rows) = fit.local.residual;
    local.residuals += fit.residuals;
    told += fit.local.told;
  }
  local.residuals -= std::lround(told);
  local.chi_square = local.residual.squaredNorm();
  local.misfit = local.chi_square + kHalfWidthInformation * at.squaredNorm();
  local.descent -= kHalfWidthInformation * at;
  return local;
}

void SegmentedMisfit::remember(const VectorXd& at, const SegmentFit* fits) {
  Anchor anchor{at, MatrixXd(recording_.scales.size(), recording_.starts.size()), {}};
  for (Index k = 0; k < anchor.states.cols(); ++k) {
    anchor.states.col(k) = fits[k].accepted + fits[k].local.step;
    anchor.slopes.push_back(fits[k].local.slopes);
  }
  if (anchors_.size() < kAnchors) {
    anchors_.push_back(std::move(anchor));
  } else {
    anchors_[oldest_] = std::move(anchor);
    oldest_ = (oldest_ + 1) % kAnchors;
  }
}

/// Few points at a time, as many as fill a batch: what their segments say takes memory.
template <class Action>
void SegmentedMisfit::fitEach(const MatrixXd& points, Action action) {
  const Index segments = recording_.starts.size();
  const Index together = std::max<Index>(1, static_cast<Index>(kBatch) / segments);
  for (Index first = 0; first < points.cols(); first += together) {
    const Index count = std::min(together, points.cols() - first);
    const std::vector<SegmentFit> fits = fitAll(points.middleCols(first, count));
    for (Index i = 0; i < count; ++i) {
      const SegmentFit* const own = fits.data() + i * segments;
      action(first + i, combine(points.col(first + i), own), own);
    }
  }
}

std::vector<LocalMisfit> SegmentedMisfit::linearizeAll(const MatrixXd& points) {
  std::vector<LocalMisfit> all;
  fitEach(points, [&](Index i, LocalMisfit local, const SegmentFit* fits) {
    all.push_back(std::move(local));
    if (all.back().status.ok) {
      remember(points.col(i), fits);
    }
  });
  return all;
}

VectorXd SegmentedMisfit::evaluate(const MatrixXd& points) {
  VectorXd misfits(points.cols());
  fitEach(points, [&](Index i, const LocalMisfit& local, const SegmentFit*) {
    misfits[i] = local.status.ok ? local.misfit : std::numeric_limits<double>::infinity();
  });
  return misfits;
}

}  // namespace twinmap
