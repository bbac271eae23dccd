#include "framework/estimation/trained/online_map.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/estimation/run_tasks.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What a map takes.
struct Sizes {
  Index features, known;
};

Sizes getSizes(const OnlineProcesses& map) {
  return {map.getFeatureCount(), map.getMap().known_inputs.center.size()};
}

Sizes getSizes(const OnlineSurrogate& map) {
  const Surrogate& surrogate = map.getSurrogate();
  return {surrogate.forward->center.size(), surrogate.center.size() - surrogate.unknown};
}

Sizes getSizes(const OnlineNetwork& map) {
  const NetworkInputs& inputs = map.getMap().inputs;
  return {inputs.center.size(), inputs.known.center.size()};
}

const MatrixXd& getCorrelation(const OnlineProcesses& map) {
  return map.getMap().residual_correlation;
}

const MatrixXd& getCorrelation(const OnlineSurrogate& map) {
  return map.getSurrogate().validation.residual_correlation;
}

const MatrixXd& getCorrelation(const OnlineNetwork& map) {
  return map.getMap().validation.residual_correlation;
}

MatrixXd makeInputsOf(const OnlineProcesses& map, const MatrixXd& features, const MatrixXd& known) {
  return map.getMap().makeProcessInputs(features, known);
}

template <class Map>
MatrixXd makeInputsOf(const Map& map, const MatrixXd& features, const MatrixXd& known) {
  return map.makeInputs(features, known);
}

bool isKnownToBeCalibrated(const OnlineProcesses&) {
  return true;
}

bool isKnownToBeCalibrated(const OnlineSurrogate& map) {
  return map.getSurrogate().validation.status == SurrogateStatus::kOk;
}

bool isKnownToBeCalibrated(const OnlineNetwork& map) {
  return map.getMap().validation.status == SurrogateStatus::kOk;
}

std::variant<OnlineProcesses, OnlineSurrogate, OnlineNetwork> prepare(AnyMap map) {
  if (auto* processes = std::get_if<GpMap>(&map)) {
    return OnlineProcesses(std::move(*processes));
  }
  if (auto* network = std::get_if<std::shared_ptr<const NetworkMap>>(&map)) {
    return OnlineNetwork(std::move(*network));
  }
  return OnlineSurrogate(std::get<std::shared_ptr<const Surrogate>>(std::move(map)));
}

}  // namespace

OnlineMap::OnlineMap(AnyMap map) : kind_(prepare(std::move(map))) {}

OnlineMap::Workspace::Workspace(const OnlineMap& map)
    : kind(std::visit(
          [](const auto& prepared) -> decltype(kind) {
            return typename std::decay_t<decltype(prepared)>::Workspace(prepared);
          },
          map.kind_)) {}

const ScoreExplanation* OnlineMap::Workspace::findExplanation() const {
  const auto* surrogate = std::get_if<OnlineSurrogate::Workspace>(&kind);
  return surrogate != nullptr ? surrogate->findExplanation() : nullptr;
}

MatrixXd OnlineMap::listBasins(const Workspace& workspace) const {
  const auto* buffers = std::get_if<OnlineSurrogate::Workspace>(&workspace.kind);
  return buffers != nullptr ? std::get<OnlineSurrogate>(kind_).listBasins(*buffers) : MatrixXd();
}

const MatrixXd& OnlineMap::getResidualCorrelation() const {
  return std::visit([](const auto& map) -> const MatrixXd& { return getCorrelation(map); }, kind_);
}

const Surrogate* OnlineMap::findSurrogate() const {
  const auto* online = std::get_if<OnlineSurrogate>(&kind_);
  return online != nullptr ? &online->getSurrogate() : nullptr;
}

bool OnlineMap::isCalibrated() const {
  return std::visit([](const auto& map) { return isKnownToBeCalibrated(map); }, kind_);
}

bool OnlineMap::givesMixtures() const {
  const auto* network = std::get_if<OnlineNetwork>(&kind_);
  return network != nullptr && network->getMap().countComponents() > 1;
}

const Estimate& OnlineMap::infer(const Eigen::Ref<const VectorXd>& features,
                                 const Eigen::Ref<const VectorXd>& known, Workspace& workspace) const {
  return std::visit(
      [&](const auto& map) -> const Estimate& {
        using Buffers = typename std::decay_t<decltype(map)>::Workspace;
        return map.infer(features, known, std::get<Buffers>(workspace.kind));
      },
      kind_);
}

const Estimate& OnlineMap::inferMean(const Eigen::Ref<const VectorXd>& features,
                                     const Eigen::Ref<const VectorXd>& known, Workspace& workspace) const {
  if (const auto* processes = std::get_if<OnlineProcesses>(&kind_)) {
    return processes->inferMean(features, known, std::get<OnlineProcesses::Workspace>(workspace.kind));
  }
  return infer(features, known, workspace);
}

Estimates OnlineMap::predict(const Eigen::Ref<const MatrixXd>& features,
                             const Eigen::Ref<const MatrixXd>& known, int threads) const {
  const Sizes sizes = std::visit([](const auto& map) { return getSizes(map); }, kind_);
  if (features.rows() != sizes.features || known.rows() != sizes.known ||
      (sizes.known > 0 && known.cols() != features.cols())) {
    throw std::invalid_argument("features or known inputs are of other sizes than the map's");
  }
  constexpr Index kBlock = 64;  // columns that share buffers
  const Index count = features.cols(), parameters = getResidualCorrelation().rows();
  Estimates all{MatrixXd(parameters, count), MatrixXd(parameters, count)};
  if (const auto* network = std::get_if<OnlineNetwork>(&kind_)) {
    all.correlations.resize(static_cast<std::size_t>(count));
    all.interval_factors = replicate(network->getMap().validation.interval_factors, count);
  }
  if (givesMixtures()) {
    all.mixtures.resize(static_cast<std::size_t>(count));
  }
  runTasks(threads, static_cast<std::size_t>((count + kBlock - 1) / kBlock), [&](std::size_t block) {
    Workspace workspace(*this);
    VectorXd settings(known.rows());
    const Index first = static_cast<Index>(block) * kBlock;
    for (Index i = first; i < std::min(count, first + kBlock); ++i) {
      if (settings.size() > 0) {
        settings = known.col(i);
      }
      const Estimate& estimate = infer(features.col(i), settings, workspace);
      all.mean.col(i) = estimate.mean;
      all.stddev.col(i) = estimate.stddev;
      if (estimate.mixture.isGiven()) {
        all.mixtures[static_cast<std::size_t>(i)] = estimate.mixture;
      }
      if (!all.correlations.empty()) {
        all.correlations[static_cast<std::size_t>(i)] = estimate.correlation;
      }
    }
  });
  return all;
}

MatrixXd OnlineMap::makeInputs(const MatrixXd& features, const MatrixXd& known) const {
  return std::visit([&](const auto& map) { return makeInputsOf(map, features, known); }, kind_);
}

}  // namespace twinmap
