#include "framework/estimation/surrogate/score_inversion.hpp"

#include <algorithm>
#include <limits>

#include "framework/estimation/box_points.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/exact/exact.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kSamePlace =
    0.05;  // half widths: nearer searches are of one minimum, as errors vary over tenths

int size(const VectorXd& vector) {
  return static_cast<int>(vector.size());
}

/// Mixes normal distributions.
gp::Moments mix(const std::vector<gp::Moments>& parts, const VectorXd& weights) {
  gp::Moments mixed{VectorXd::Zero(parts.front().mean.size()), {}};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    mixed.mean += weights(static_cast<Index>(i)) * parts[i].mean;
  }
  mixed.covariance.setZero(mixed.mean.size(), mixed.mean.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const VectorXd apart = parts[i].mean - mixed.mean;
    mixed.covariance += weights(static_cast<Index>(i)) * (parts[i].covariance + apart * apart.transpose());
  }
  return mixed;
}

}  // namespace

MatrixXd ScoreExplanation::calcCovariance() const {
  return linalg::invertPositiveDefinite(jacobian.transpose() * jacobian + prior);
}

VectorXd ScoreExplanation::whiten(VectorXd scores) const {
  exact::solveColumns(size(scores), lower.data(), scores.data());
  return scores;
}

ScoreInversion::ScoreInversion(const ForwardSurrogate& surrogate, BoxPrior prior)
    : surrogate_(surrogate),
      prior_(std::move(prior)),
      unknown_(prior_.count()),
      workspaces_(surrogate.windows.size()),
      widening_(surrogate.windows.size(), 1.0),
      point_(surrogate.points.rows()),
      values_(VectorXd::Zero(surrogate.getScoreCount())),
      stddev_(surrogate.getScoreCount()),
      gradient_(unknown_),
      step_(unknown_),
      offset_(unknown_),
      pull_(unknown_),
      jacobian_(MatrixXd::Zero(surrogate.getScoreCount(), unknown_)),
      normal_(unknown_, unknown_),
      small_(unknown_, unknown_) {
  rough_.weights = calcRoughWeights(surrogate);
  explanation_.prior = prior_.calcInformation();
  LeadingScores leading = findLeadingScores(surrogate, unknown_);
  leading_.weights = std::move(leading.weights);
  leading_.counts = std::move(leading.counts);
}

std::vector<VectorXd> ScoreInversion::findStarts() const {
  constexpr std::size_t kStarts = 3;
  constexpr double kApart = 0.5;  // in half widths: nearer starts lead to the same minimum
  std::vector<VectorXd> starts;
  for (const Index simulation : rankSimulations(surrogate_, scores_)) {
    const VectorXd point = surrogate_.points.col(simulation).head(unknown_);
    const bool apart = std::all_of(starts.begin(), starts.end(), [&](const VectorXd& start) {
      return (start - point).cwiseAbs().maxCoeff() > kApart;
    });
    if (apart) {
      starts.push_back(point);
    }
    if (starts.size() == kStarts) {
      break;
    }
  }
  return starts;
}

/// Values and derivatives, for a trial is nearly always accepted.
void ScoreInversion::evaluate(const Metric& metric, const VectorXd& unknown) {
  const Evaluated wanted = metric.counts.empty() ? Evaluated::kAll : Evaluated::kLeading;
  if (evaluated_ >= wanted && point_.head(unknown_) == unknown) {
    return;
  }
  evaluated_ = wanted;
  point_.head(unknown_) = unknown;
  Index first = 0;
  for (std::size_t w = 0; w < workspaces_.size(); ++w) {
    const gp::SharedProcess& process = surrogate_.windows[w];
    if (const Index count = metric.count(w, process); count > 0) {
      process.linearize(point_, values_.segment(first, count), jacobian_.middleRows(first, count),
                        workspaces_[w]);
    }
    first += process.getFunctionCount();
  }
}

double ScoreInversion::calcObjective(const Metric& metric, const VectorXd& unknown) {
  evaluate(metric, unknown);
  residual_ = scores_ - values_;
  if (metric.diagonal) {
    residual_.array() *= metric.weights;
  } else {
    exact::solveColumns(size(residual_), metric.lower.data(), residual_.data());
  }
  calcPull(unknown);
  return exact::dot(size(residual_), residual_.data(), residual_.data()) +
         kHalfWidthInformation * exact::dot(size(offset_), offset_.data(), pull_.data());
}

/// Into offset_ and pull_.
void ScoreInversion::calcPull(const VectorXd& unknown) {
  exact::calcPull(size(unknown), prior_.relative.data(), prior_.mean.data(), unknown.data(), offset_.data(),
                  pull_.data());
}

/// At the point evaluated last.
void ScoreInversion::makeNormalEquations(const Metric& metric) {
  const int r = size(residual_), u = size(gradient_);
  scaled_jacobian_ = jacobian_;
  if (metric.diagonal) {
    scaled_jacobian_.array().colwise() *= metric.weights;
  }
  for (Index v = 0; v < unknown_; ++v) {
    double* column = scaled_jacobian_.col(v).data();
    if (!metric.diagonal) {
      exact::solveColumns(r, metric.lower.data(), column);
    }
    gradient_(v) = exact::dot(r, column, residual_.data());
  }
  exact::calcInformation(r, u, scaled_jacobian_.data(), normal_.data());
}

/// Into step_.
bool ScoreInversion::solveStep(const VectorXd& unknown, double damping) {
  step_ = gradient_;
  calcPull(unknown);
  return exact::solveStep(size(step_), normal_.data(), prior_.relative.data(), pull_.data(), damping,
                          small_.data(), step_.data());
}

bool ScoreInversion::step(const Metric& metric, VectorXd& unknown, Descent& descent) {
  constexpr double kFactor = 10.0, kMaxDamping = 1e6, kMinDamping = 1e-6;
  for (; descent.damping < kMaxDamping; descent.damping *= kFactor) {
    if (!solveStep(unknown, descent.damping)) {
      continue;
    }
    const VectorXd trial = clampToBox(unknown + step_);
    const double tried = calcObjective(metric, trial);
    if (tried < descent.objective) {
      unknown = trial;
      descent.objective = tried;
      descent.damping = std::max(descent.damping / kFactor, kMinDamping);
      return true;
    }
  }
  return false;
}

/// False where the search has converged: a step would gain little, as the linear model predicts, or did.
bool ScoreInversion::advance(const Metric& metric, VectorXd& unknown, Descent& descent) {
  makeNormalEquations(metric);
  return predictGain(unknown) >= kLastGain && moveOn(metric, unknown, descent);
}

/// The rest of advance() where a step would gain something.
bool ScoreInversion::moveOn(const Metric& metric, VectorXd& unknown, Descent& descent) {
  const double before = descent.objective;
  if (!step(metric, unknown, descent)) {
    descent.objective = calcObjective(metric, unknown);
    return false;
  }
  return before - descent.objective >= kLastGain;
}

/// Of an undamped step that no bound stops, which step_ then is.
double ScoreInversion::predictGain(const VectorXd& unknown) {
  return solveStep(unknown, 0.0) ? (gradient_ - kHalfWidthInformation * pull_).dot(step_)
                                 : std::numeric_limits<double>::infinity();
}

double ScoreInversion::improve(const Metric& metric, int steps, VectorXd& unknown) {
  Descent descent{calcObjective(metric, unknown)};
  for (int i = 0; i < steps && advance(metric, unknown, descent); ++i) {
  }
  return descent.objective;
}

void ScoreInversion::updateMetric(const VectorXd& unknown, Metric& metric) {
  metric.diagonal = false;
  evaluate(metric, unknown);
  Index first = 0;
  for (std::size_t w = 0; w < workspaces_.size(); ++w) {
    const gp::SharedProcess& process = surrogate_.windows[w];
    auto stddev = stddev_.segment(first, process.getFunctionCount());
    process.calcStddev(stddev, workspaces_[w]);
    stddev *= widening_[w];
    first += process.getFunctionCount();
  }
  const Index r = stddev_.size();
  metric.lower.resize(r * (r + 1) / 2);
  for (Index j = 0, at = 0; j < r; at += r - j, ++j) {
    metric.lower.segment(at, r - j) =
        stddev_.tail(r - j).cwiseProduct(surrogate_.error_correlation.col(j).tail(r - j)) * stddev_(j);
    metric.lower(at) += 1.0;
  }
  exact::factorise(size(stddev_), metric.lower.data());
  metric.log_determinant = exact::calcLogDeterminant(size(stddev_), metric.lower.data());
}

std::vector<ScoreInversion::Minimum> ScoreInversion::searchRoughly(const std::vector<VectorXd>& starts) {
  std::vector<Minimum> minima;
  const auto is_apart = [&](const VectorXd& point) {
    return std::all_of(minima.begin(), minima.end(), [&](const Minimum& other) {
      return (other.point - point).cwiseAbs().maxCoeff() > kSamePlace;
    });
  };
  for (const VectorXd& start : starts) {
    Minimum minimum;
    minimum.point = start;
    Descent descent{calcObjective(leading_, minimum.point)};
    bool moves = true, apart = true;
    for (int i = 0; i < kFewIterations && moves && apart; ++i) {
      makeNormalEquations(leading_);
      moves = predictGain(minimum.point) >= kLastGain;
      apart = is_apart(minimum.point + step_);  // before the step, which costs an evaluation
      if (moves && apart) {
        moves = moveOn(leading_, minimum.point, descent);
        apart = is_apart(minimum.point);
      }
    }
    if (apart) {
      minimum.objective = calcObjective(rough_, minimum.point);
      minima.push_back(minimum);
    }
  }
  std::stable_sort(minima.begin(), minima.end(),
                   [](const Minimum& a, const Minimum& b) { return a.objective < b.objective; });
  const double worst = minima.front().objective + kBasinAbove;
  while (minima.back().objective > worst) {
    minima.pop_back();
  }
  return minima;
}

/// Where the residuals at a minimum are beyond what the errors allow, those of the windows that are to blame
/// are taken to be as large as that; false where nothing is. Next to a jump, such as that of a contact made
/// or missed, no simulation tells how wrong a process is.
bool ScoreInversion::widen(const Metric& metric, const VectorXd& unknown) {
  (void)calcObjective(metric, unknown);
  if (!exact::isMisfit(exact::dot(size(residual_), residual_.data(), residual_.data()), size(residual_))) {
    return false;
  }
  bool widened = false;
  Index first = 0;
  for (std::size_t w = 0; w < workspaces_.size(); ++w) {
    const Index count = surrogate_.windows[w].getFunctionCount();
    const double factor = exact::calcWidening(static_cast<int>(count), stddev_.data() + first,
                                              scores_.data() + first, values_.data() + first);
    if (factor > 0.0) {
      widening_[w] *= factor;
      widened = true;
    }
    first += count;
  }
  return widened;
}

/// `may_widen`: where a measurement is to be explained at any cost, not where it is to be judged.
void ScoreInversion::refine(Minimum& minimum, bool may_widen) {
  std::fill(widening_.begin(), widening_.end(), 1.0);
  Metric metric;
  const VectorXd before = minimum.point;
  updateMetric(before, metric);
  minimum.objective = improve(metric, kFewIterations, minimum.point);
  if ((minimum.point - before).cwiseAbs().maxCoeff() > kSamePlace) {
    updateMetric(minimum.point, metric);
    minimum.objective = improve(metric, kFewIterations, minimum.point);
  }
  minimum.residual = residual_;
  for (int i = 0; may_widen && i < kFewIterations && widen(metric, minimum.point); ++i) {
    updateMetric(minimum.point, metric);
    minimum.objective = improve(metric, kFewIterations, minimum.point);
    minimum.widened = true;
  }
  minimum.widening = widening_;
  makeNormalEquations(metric);
  minimum.information = normal_ + prior_.within;
  const int u = size(gradient_);
  minimum.noise_information.resize(unknown_, unknown_);
  exact::calcInformation(size(residual_), u, jacobian_.data(), minimum.noise_information.data());
  minimum.shift = gradient_;
  for (Index v = 0; v < unknown_; ++v) {
    minimum.shift(v) += exact::dot(u, normal_.col(v).data(), minimum.point.data());
  }
  minimum.shift += prior_.shift;
  const MatrixXd posterior = normal_ + prior_.calcInformation();
  minimum.jacobian = scaled_jacobian_;
  minimum.lower = std::move(metric.lower);
  minimum.objective +=
      metric.log_determinant + exact::calcSmallLogDeterminant(u, posterior.data(), small_.data());
}

void ScoreInversion::keepExplanation(Minimum& minimum) {
  explanation_.point = point_;
  explanation_.point.head(unknown_) = minimum.point;
  explanation_.innovation = std::move(minimum.residual);
  explanation_.lower = std::move(minimum.lower);
  explanation_.jacobian = std::move(minimum.jacobian);
}

void ScoreInversion::keepModes(const std::vector<Minimum>& minima, const std::vector<gp::Moments>& parts,
                               const VectorXd& shares) {
  modes_.clear();
  for (std::size_t i = 0; i < minima.size(); ++i) {
    if (const double share = shares(static_cast<Index>(i)); share > 0.0) {
      modes_.push_back({share, parts[i], minima[i].widening});
    }
  }
  std::stable_sort(modes_.begin(), modes_.end(),
                   [](const ScoreMode& a, const ScoreMode& b) { return a.share > b.share; });
}

/// Whether the better metric made a minimum one with an earlier one.
bool ScoreInversion::hasEarlierTwin(const std::vector<Minimum>& minima, std::size_t index) {
  return std::any_of(minima.begin(), minima.begin() + static_cast<std::ptrdiff_t>(index),
                     [&](const Minimum& other) {
                       return (other.point - minima[index].point).cwiseAbs().maxCoeff() < kSamePlace;
                     });
}

gp::Moments ScoreInversion::infer(const Eigen::Ref<const VectorXd>& scores,
                                  const Eigen::Ref<const VectorXd>& known) {
  scores_ = scores;
  evaluated_ = Evaluated::kNone;
  point_.tail(known.size()) = known;
  std::vector<Minimum> minima = searchRoughly(findStarts());
  std::vector<gp::Moments> parts;
  VectorXd objectives(static_cast<Index>(minima.size()));
  for (std::size_t i = 0; i < minima.size(); ++i) {
    refine(minima[i], true);
    objectives(static_cast<Index>(i)) = minima[i].objective;
    parts.push_back(gp::calcBoxMoments(minima[i].information, minima[i].shift));
  }
  VectorXd weights = (-0.5 * (objectives.array() - objectives.minCoeff())).exp();
  for (std::size_t i = 1; i < minima.size(); ++i) {
    if (hasEarlierTwin(minima, i)) {
      weights(static_cast<Index>(i)) = 0.0;
    }
  }
  weights /= weights.sum();
  keepModes(minima, parts, weights);
  Index best = 0;
  weights.maxCoeff(&best);
  Minimum& likeliest = minima[static_cast<std::size_t>(best)];
  VectorXd noise_shift(unknown_);
  for (Index v = 0; v < unknown_; ++v) {
    noise_shift(v) =
        exact::dot(size(noise_shift), likeliest.noise_information.col(v).data(), likeliest.point.data());
  }
  noise_stddev_ = gp::calcBoxMoments(likeliest.noise_information + prior_.within, noise_shift + prior_.shift)
                      .covariance.diagonal()
                      .cwiseSqrt();
  explained_ = !likeliest.widened;
  if (explained_) {
    keepExplanation(likeliest);
  }
  return mix(parts, weights);
}

const ScoreExplanation& ScoreInversion::explain(const Eigen::Ref<const VectorXd>& scores,
                                                const Eigen::Ref<const VectorXd>& known,
                                                const Eigen::Ref<const VectorXd>& start) {
  scores_ = scores;
  evaluated_ = Evaluated::kNone;
  point_.tail(known.size()) = known;
  const VectorXd within = clampToBox(start);
  std::vector<Minimum> minima = searchRoughly({within});
  if (exact::isMisfit(minima.front().objective, size(scores_))) {
    std::vector<VectorXd> starts = findStarts();
    starts.insert(starts.begin(), within);
    minima = searchRoughly(starts);
  }
  for (Minimum& minimum : minima) {
    refine(minimum, false);
  }
  Minimum& best = *std::min_element(minima.begin(), minima.end(), [](const Minimum& a, const Minimum& b) {
    return a.objective < b.objective;
  });
  keepExplanation(best);
  return explanation_;
}

}  // namespace twinmap
