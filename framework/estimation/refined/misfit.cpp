#include "framework/estimation/refined/misfit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/log/search_stage.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/refined/thinned_misfit.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd LocalMisfit::calcHessian() const {
  MatrixXd hessian = calcInformationWithin();
  if (box.size() == 0) {
    return addBounds(std::move(hessian));
  }
  hessian.diagonal() += box;
  return hessian;
}

VectorXd LocalMisfit::calcDescentWithin() const {
  return box.size() == 0 ? VectorXd(descent + kHalfWidthInformation * at)
                         : VectorXd(descent + box.cwiseProduct(at));
}

MatrixXd LocalMisfit::calcInformationWithin() const {
  return beside.information.size() == 0 ? information : MatrixXd(information + beside.information);
}

MatrixXd LocalMisfit::calcCovariance() const {
  return linalg::invertPositiveDefinite(calcHessian());
}

double LocalMisfit::calcDegrees() const {
  const double determined = calcCovariance().cwiseProduct(information).sum();
  return std::max(1.0, static_cast<double>(residuals) - determined);
}

Misfit::Misfit(Simulator& simulator, const RefinementModel& model, const SearchBox& box,
               const VectorXd& measured, const Prior* prior)
    : simulator_(simulator),
      model_(model),
      box_(box),
      measured_(model.convert(measured)),
      prior_(prior),
      box_information_(VectorXd::Constant(box.getSearched().count, kHalfWidthInformation)),
      window_(&model.getWhole()) {
  for (Index j = 0; j < box_information_.size() && prior_ != nullptr; ++j) {
    if (prior_->hasRange(box.getSearched().first + j)) {
      box_information_[j] = 0.0;
    }
  }
}

/// Of the searched parameters, the others held.
PriorMisfit Misfit::calcBeside(const VectorXd& at) const {
  const SearchedParameters& searched = box_.getSearched();
  const auto chosen = Eigen::seqN(searched.first, searched.count);
  const auto unknown = static_cast<Index>(model_.getUnknown().size());
  const PriorMisfit whole = prior_->calcMisfit(box_.makePoint(at).head(unknown));
  const VectorXd& scale = box_.getHalfWidths();
  return {whole.misfit, scale.cwiseProduct(whole.descent(chosen)),
          scale.asDiagonal() * whole.information(chosen, chosen) * scale.asDiagonal()};
}

/// residual: whitened, k; jacobian: of the features, whitened, k x s.
LocalMisfit Misfit::combine(const SampleStatus& status, const VectorXd& at, const VectorXd& residual,
                            const MatrixXd& jacobian) const {
  const double chi_square = residual.squaredNorm();
  LocalMisfit local{status,
                    at,
                    chi_square,
                    chi_square + kHalfWidthInformation * at.squaredNorm(),
                    residual.size(),
                    jacobian.transpose() * jacobian,
                    jacobian.transpose() * residual - kHalfWidthInformation * at,
                    residual,
                    jacobian};
  if (prior_ != nullptr) {
    local.box = box_information_;
    local.beside = calcBeside(at);
    local.misfit = local.calcMisfitWithin() + at.dot(local.box.cwiseProduct(at));
    local.descent = jacobian.transpose() * residual + local.beside.descent - local.box.cwiseProduct(at);
  }
  return local;
}

/// Misfits from chi-squares at the columns of `points`.
VectorXd Misfit::addPrior(VectorXd chi_squares, const MatrixXd& points) const {
  if (prior_ == nullptr) {
    return chi_squares + kHalfWidthInformation * points.colwise().squaredNorm().transpose();
  }
  for (Index i = 0; i < points.cols(); ++i) {
    const VectorXd at = points.col(i);
    chi_squares[i] += calcBeside(at).misfit + at.dot(box_information_.cwiseProduct(at));
  }
  return chi_squares;
}

namespace {

/// The features of a window that are sampled at these times, as rows of a response at them.
ThinnedMisfit::Samples takeSamples(const GrowingWindow& window, const std::vector<FeatureInfo>& infos,
                                   const VectorXd& measured, const VectorXd& times) {
  ThinnedMisfit::Samples samples;
  std::vector<Index> kept;
  for (std::size_t i = 0; i < window.features.size(); ++i) {
    const FeatureInfo& info = infos[static_cast<std::size_t>(window.features[i])];
    const auto found = std::lower_bound(times.begin(), times.end(), info.time);
    if (found != times.end() && *found == info.time) {
      kept.push_back(static_cast<Index>(i));
      samples.rows.push_back(info.output * times.size() + (found - times.begin()));
    }
  }
  const double counts = static_cast<double>(window.features.size()) / static_cast<double>(kept.size());
  samples.scale = std::sqrt(counts) * window.whitener->getScale()(kept);
  samples.measured = measured(window.features)(kept);
  return samples;
}

}  // namespace

std::unique_ptr<MeasuredMisfit> Misfit::makeThinned() const {
  const std::vector<FeatureInfo>& infos = model_.getExtractor().getInfos();
  const bool are_samples = std::all_of(window_->features.begin(), window_->features.end(), [&](Index i) {
    return infos[static_cast<std::size_t>(i)].isSample();
  });
  if (prior_ != nullptr || !are_samples || !window_->whitener || !window_->whitener->isDiagonal() ||
      !simulator_.hasDerivatives()) {
    return nullptr;
  }
  const VectorXd times = chooseTimes(simulator_.getLayout(), static_cast<Index>(window_->features.size()),
                                     box_information_.size());
  std::unique_ptr<Simulator> simulator = times.size() > 0 ? simulator_.cloneAt(times) : nullptr;
  ThinnedMisfit::Samples samples = takeSamples(*window_, infos, measured_, times);
  if (!simulator || samples.rows.empty()) {
    return nullptr;
  }
  return std::make_unique<ThinnedMisfit>(std::move(simulator), std::move(samples), box_);
}

void Misfit::setWindow(const GrowingWindow& window) {
  window_ = &window;
  renewNoise();
}

const NoiseWhitener& Misfit::getWhitener() const {
  return window_->whitener ? *window_->whitener : *whitener_;
}

std::vector<LocalMisfit> Misfit::linearizeAll(const MatrixXd& points) {
  const int neighbours = countNeighbours(model_.getUnknown().size());
  const Index most = countTogether(neighbours);
  std::vector<LocalMisfit> all;
  for (Index first = 0; first < points.cols(); first += most) {
    linearizeBatch(points.middleCols(first, std::min(most, points.cols() - first)), neighbours, all);
  }
  return all;
}

Index Misfit::countTogether(int responses) const {
  return std::max<Index>(
      1, kNumbersTogether / (responses * std::max<Index>(1, simulator_.getLayout().getRowCount())));
}

void Misfit::linearizeBatch(const MatrixXd& points, int neighbours, std::vector<LocalMisfit>& all) {
  const MatrixXd sampled = box_.makePoints(points);
  MatrixXd stencils(simulator_.getLayout().getRowCount() * neighbours, points.cols());
  std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
  simulateStencils(simulator_, model_.getUnknown(), sampled, stencils, statuses.data());
  const int simulated = static_cast<int>(points.cols()) * (simulator_.hasDerivatives() ? 1 : neighbours);
  simulations_ += simulated;
  noteSimulations(simulated);
  for (Index i = 0; i < points.cols(); ++i) {
    all.push_back(makeLocalMisfit(points.col(i),
                                  makeLocalModel(model_.getExtractor(), model_.getUnknown(), sampled.col(i),
                                                 stencils.col(i), statuses[static_cast<std::size_t>(i)])));
  }
}

LocalMisfit Misfit::makeLocalMisfit(const VectorXd& at, const LocalModel& local) {
  const SearchedParameters& searched = box_.getSearched();
  if (!local.status.ok) {
    return {local.status, {}, 0.0, 0.0, 0, {}, {}, {}, {}};
  }
  if (!window_->whitener && !whitener_) {
    whitener_ = model_.makeWhitener(*window_, local.response);
  }
  const VectorXd difference = (measured_ - local.features)(window_->features);
  const MatrixXd sensitivities =
      0.5 * local.sensitivities(window_->features, Eigen::seqN(searched.first, searched.count));
  return combine(local.status, at, getWhitener().apply(difference), getWhitener().apply(sensitivities));
}

MatrixXd Misfit::simulateResiduals(const MatrixXd& points, std::vector<SampleStatus>& statuses) {
  const MatrixXd sampled = box_.makePoints(points);
  MatrixXd responses(simulator_.getLayout().getRowCount(), points.cols());
  statuses.resize(static_cast<std::size_t>(points.cols()));
  simulator_.simulate(sampled, responses, statuses.data());
  simulations_ += static_cast<int>(points.cols());
  noteSimulations(points.cols());
  const MatrixXd differences = (-model_.getExtractor().extract(responses)).colwise() + measured_;
  return getWhitener().apply(differences(window_->features, Eigen::all));
}

ProbedMisfit Misfit::probe(const VectorXd& at, const MatrixXd& ways) {
  const Index s = at.size();
  MatrixXd points(s, 2 * s + 1);
  points.leftCols(s) = ways;
  points.middleCols(s, s) = -ways;
  points.col(2 * s).setZero();
  points.colwise() += at;
  std::vector<SampleStatus> statuses;
  const MatrixXd residuals = simulateResiduals(points, statuses);
  ProbedMisfit probed;
  for (const SampleStatus& status : statuses) {
    if (!status.ok) {
      probed.local.status = status;
      return probed;
    }
  }
  const MatrixXd along = 0.5 * (residuals.middleCols(s, s) - residuals.leftCols(s));
  const MatrixXd jacobian =
      along * ways.colwise().squaredNorm().cwiseInverse().asDiagonal() * ways.transpose();
  probed.local = combine({}, at, residuals.col(2 * s), jacobian);
  probed.ways = ways;
  probed.misfits = addPrior(residuals.leftCols(2 * s).colwise().squaredNorm(), points.leftCols(2 * s));
  return probed;
}

VectorXd Misfit::evaluate(const MatrixXd& points) {
  return addPrior(
      sumUp(points, [](const MatrixXd& residuals) { return residuals.colwise().squaredNorm().transpose(); }),
      points);
}

VectorXd Misfit::sumUp(const MatrixXd& points, const std::function<VectorXd(const MatrixXd&)>& calcLosses) {
  const Index most = countTogether(1);
  VectorXd losses(points.cols());
  for (Index first = 0; first < points.cols(); first += most) {
    std::vector<SampleStatus> statuses;
    const Index count = std::min(most, points.cols() - first);
    losses.segment(first, count) = calcLosses(simulateResiduals(points.middleCols(first, count), statuses));
    for (Index i = 0; i < count; ++i) {
      double& loss = losses[first + i];
      loss = statuses[static_cast<std::size_t>(i)].ok && std::isfinite(loss)
                 ? loss
                 : std::numeric_limits<double>::infinity();
    }
  }
  return losses;
}

}  // namespace twinmap
