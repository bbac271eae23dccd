#include "framework/study/pipeline/training/train_maps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <memory>

#include "framework/base/log/log.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "framework/study/pipeline/training/fit_online.hpp"

namespace twinmap {
namespace {

/// Makes the map ready for measurements.
OnlineFit prepareOnline(const Study& study, const PreparedData& data, std::shared_ptr<const Estimator> map,
                        std::shared_ptr<const ForwardSurrogate> forward = nullptr) {
  StageNotes notes;
  OnlineFit online = timeStage("calibrate the goodness-of-fit test", notes,
                               [&] { return fitOnline(study, data, std::move(map), std::move(forward)); });
  notes.append(online.notes);
  online.notes = notes;
  return online;
}

/// Trains a surrogate. What is inferred with it does not depend on the threads.
TrainedMap trainForward(const Study& study, const PreparedData& data) {
  return makeTrainedMap(study, data, trainSurrogateMap(study, data));
}

/// Trains one Gaussian process per parameter.
TrainedMap trainProcesses(const Study& study, const PreparedData& data) {
  return makeTrainedMap(study, data, trainMap(study, data.labelled.train));
}

/// Trains a neural network.
TrainedMap trainNeurally(const Study& study, const PreparedData& data) {
  NetworkOutcome outcome = trainNetwork(study, data);
  const auto map = std::make_shared<const NetworkMap>(std::move(outcome.map));
  OnlineFit online = prepareOnline(study, data, std::make_shared<const OnlineNetwork>(map), outcome.forward);
  outcome.notes.append(online.notes);
  const auto predict = [map, threads = study.control.threads](const Eigen::MatrixXd& features,
                                                              const Eigen::MatrixXd& inputs) {
    return map->predict(features, inputs, threads);
  };
  return {"network",
          predict,
          map->validation.residual_correlation,
          std::move(outcome.transform),
          std::move(outcome.summary),
          std::move(outcome.notes),
          std::move(online.model)};
}

TrainedMap trainAutomatically(const Study& study, const PreparedData& data) {
  const LabelledFeatures& train = data.labelled.train;
  const std::string obstacle = findSurrogateObstacle(
      study.experiment.model, train.features.cols() / train.replicates, train.noise_covariance);
  if (obstacle.empty()) {
    return trainForward(study, data);
  }
  logInfo(fmt::format("inverse map: Gaussian processes, because {}", obstacle));
  return trainProcesses(study, data);
}

/// How the kinds of `inverse_map` are trained.
struct Trainer {
  const char* kind;
  bool (*isAskedFor)(const InverseMapSpec& spec);
  TrainedMap (*train)(const Study& study, const PreparedData& data);
};

template <class Spec>
bool isOf(const InverseMapSpec& spec) {
  return std::holds_alternative<Spec>(spec.kind);
}

constexpr Trainer kTrainers[] = {{"automatic", isOf<AutomaticMapSpec>, trainAutomatically},
                                 {"gp", isOf<GpMapSpec>, trainProcesses},
                                 {"surrogate", isOf<SurrogateMapSpec>, trainForward},
                                 {"network", isOf<NetworkMapSpec>, trainNeurally}};

const Trainer& findTrainer(const InverseMapSpec& spec) {
  const Trainer* found = std::find_if(std::begin(kTrainers), std::end(kTrainers),
                                      [&](const Trainer& trainer) { return trainer.isAskedFor(spec); });
  assert(found != std::end(kTrainers));
  return *found;
}

}  // namespace

TrainedMap makeTrainedMap(const Study& study, const PreparedData& data, Training training) {
  OnlineFit online =
      prepareOnline(study, data, std::make_shared<const OnlineProcesses>(compressMap(training.map)));
  training.notes.append(online.notes);
  const auto map = std::make_shared<const GpMap>(std::move(training.map));
  const auto predict = [map](const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs) {
    return map->predict(features, inputs);
  };
  return {"gp",
          predict,
          map->residual_correlation,
          map->transform,
          std::move(training.summary),
          std::move(training.notes),
          std::move(online.model)};
}

TrainedMap makeTrainedMap(const Study& study, const PreparedData& data, SurrogateMapTraining training) {
  const auto surrogate = std::make_shared<const Surrogate>(std::move(training.surrogate));
  OnlineFit online = prepareOnline(study, data, std::make_shared<const OnlineSurrogate>(surrogate));
  training.notes.append(online.notes);
  const auto predict = [surrogate, threads = study.control.threads](const Eigen::MatrixXd& features,
                                                                    const Eigen::MatrixXd& inputs) {
    return surrogate->predict(features, inputs, threads);
  };
  return {"surrogate",
          predict,
          surrogate->validation.residual_correlation,
          fitTransform(study.experiment.transform, data.labelled.train),
          std::move(training.summary),
          std::move(training.notes),
          std::move(online.model)};
}

TrainedMap trainChosenMap(const Study& study, const PreparedData& data) {
  return findTrainer(study.experiment.inverse_map).train(study, data);
}

const char* getEstimatorKind(const InverseMapSpec& spec) {
  return findTrainer(spec).kind;
}

}  // namespace twinmap
