#include "framework/online/online_map.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/surrogate/run_tasks.hpp"

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

std::variant<OnlineProcesses, OnlineSurrogate> prepare(AnyMap map) {
  if (auto* processes = std::get_if<GpMap>(&map)) {
    return OnlineProcesses(std::move(*processes));
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

const MatrixXd& OnlineMap::getResidualCorrelation() const {
  if (const auto* processes = std::get_if<OnlineProcesses>(&kind_)) {
    return processes->getMap().residual_correlation;
  }
  return std::get<OnlineSurrogate>(kind_).getSurrogate().validation.residual_correlation;
}

bool OnlineMap::isHonest() const {
  const auto* surrogate = std::get_if<OnlineSurrogate>(&kind_);
  return surrogate == nullptr || surrogate->getSurrogate().validation.status == SurrogateStatus::kOk;
}

const Inference& OnlineMap::infer(const Eigen::Ref<const VectorXd>& features,
                                  const Eigen::Ref<const VectorXd>& known, Workspace& workspace) const {
  if (const auto* processes = std::get_if<OnlineProcesses>(&kind_)) {
    return processes->infer(features, known, std::get<OnlineProcesses::Workspace>(workspace.kind));
  }
  return std::get<OnlineSurrogate>(kind_).infer(features, known,
                                                std::get<OnlineSurrogate::Workspace>(workspace.kind));
}

const Inference& OnlineMap::inferMean(const Eigen::Ref<const VectorXd>& features,
                                      const Eigen::Ref<const VectorXd>& known, Workspace& workspace) const {
  if (const auto* processes = std::get_if<OnlineProcesses>(&kind_)) {
    return processes->inferMean(features, known, std::get<OnlineProcesses::Workspace>(workspace.kind));
  }
  return infer(features, known, workspace);
}

Predictions OnlineMap::predict(const Eigen::Ref<const MatrixXd>& features,
                               const Eigen::Ref<const MatrixXd>& known, int threads) const {
  const Sizes sizes = std::visit([](const auto& map) { return getSizes(map); }, kind_);
  if (features.rows() != sizes.features || known.rows() != sizes.known ||
      (sizes.known > 0 && known.cols() != features.cols())) {
    throw std::invalid_argument("features or known inputs are of other sizes than the map's");
  }
  constexpr Index kBlock = 64;  // columns that share buffers
  const Index count = features.cols(), parameters = getResidualCorrelation().rows();
  Predictions all{MatrixXd(parameters, count), MatrixXd(parameters, count)};
  runTasks(threads, static_cast<std::size_t>((count + kBlock - 1) / kBlock), [&](std::size_t block) {
    Workspace workspace(*this);
    VectorXd settings(known.rows());
    const Index first = static_cast<Index>(block) * kBlock;
    for (Index i = first; i < std::min(count, first + kBlock); ++i) {
      if (settings.size() > 0) {
        settings = known.col(i);
      }
      const Inference& inference = infer(features.col(i), settings, workspace);
      all.mean.col(i) = inference.mean;
      all.stddev.col(i) = inference.stddev;
    }
  });
  return all;
}

MatrixXd OnlineMap::makeInputs(const MatrixXd& features, const MatrixXd& known) const {
  if (const auto* processes = std::get_if<OnlineProcesses>(&kind_)) {
    return processes->getMap().makeProcessInputs(features, known);
  }
  return std::get<OnlineSurrogate>(kind_).makeInputs(features, known);
}

}  // namespace twinmap
