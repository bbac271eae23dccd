#include "framework/online/online_map.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

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
  if (const auto* processes = std::get_if<OnlineProcesses>(&kind_)) {
    return processes->predict(features, known, threads);
  }
  return std::get<OnlineSurrogate>(kind_).getSurrogate().predict(features, known, threads);
}

MatrixXd OnlineMap::makeInputs(const MatrixXd& features, const MatrixXd& known) const {
  if (const auto* processes = std::get_if<OnlineProcesses>(&kind_)) {
    return processes->getMap().makeProcessInputs(features, known);
  }
  return std::get<OnlineSurrogate>(kind_).makeInputs(features, known);
}

}  // namespace twinmap
