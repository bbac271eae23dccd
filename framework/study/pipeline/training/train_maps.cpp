#include "framework/study/pipeline/training/train_maps.hpp"

#include <fmt/core.h>

#include <memory>

#include "framework/base/log/log.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "framework/study/pipeline/training/fit_online.hpp"
#include "framework/study/pipeline/training/train_surrogate_map.hpp"

namespace twinmap {
namespace {

/// Makes the map ready for measurements.
template <class... Map>
OnlineFit prepareOnline(const MapTrainingContext& context, const Map&... map) {
  StageNotes notes;
  OnlineFit online = timeStage("prepare for measurements", notes, [&] {
    return fitOnline({context.experiment,
                      context.sets,
                      context.extractor,
                      context.labelled,
                      {context.control.threads, context.control.abandon}},
                     map...);
  });
  notes.append(online.notes);
  online.notes = notes;
  return online;
}

/// Trains a surrogate. What is inferred with it does not depend on the threads.
TrainedMap trainForward(const MapTrainingContext& context) {
  return makeTrainedMap(
      context, trainSurrogateMap(context.experiment, context.sets, context.simulator, context.extractor,
                                 context.labelled.train, context.control));
}

/// Trains one Gaussian process per parameter.
TrainedMap trainProcesses(const MapTrainingContext& context) {
  return makeTrainedMap(context, trainMap(context.experiment, context.labelled.train, context.control));
}

/// Trains a neural network.
TrainedMap trainNeurally(const MapTrainingContext& context) {
  NetworkOutcome outcome = trainNetwork({context.experiment, context.sets, context.simulator,
                                         context.extractor, context.labelled.train, context.control});
  const auto map = std::make_shared<const NetworkMap>(std::move(outcome.map));
  OnlineFit online = prepareOnline(context, map, outcome.forward);
  outcome.notes.append(online.notes);
  const auto predict = [map, threads = context.control.threads](const Eigen::MatrixXd& features,
                                                                const Eigen::MatrixXd& inputs) {
    return map->predict(features, inputs, threads);
  };
  return {"network",
          predict,
          map->validation.residual_correlation,
          std::move(outcome.transform),
          std::move(outcome.summary),
          std::move(outcome.notes),
          std::move(online.model),
          {}};
}

TrainedMap trainAutomatically(const MapTrainingContext& context) {
  const LabelledFeatures& train = context.labelled.train;
  const std::string obstacle = findSurrogateObstacle(
      context.experiment.model, train.features.cols() / train.replicates, train.noise_covariance);
  if (obstacle.empty()) {
    return trainForward(context);
  }
  logInfo(fmt::format("inverse map: Gaussian processes, because {}", obstacle));
  return trainProcesses(context);
}

}  // namespace

TrainedMap makeTrainedMap(const MapTrainingContext& context, Training training) {
  OnlineFit online = prepareOnline(context, training.map);
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
          std::move(online.model),
          *map};
}

TrainedMap makeTrainedMap(const MapTrainingContext& context, SurrogateMapTraining training) {
  const auto surrogate = std::make_shared<const Surrogate>(std::move(training.surrogate));
  OnlineFit online = prepareOnline(context, surrogate);
  training.notes.append(online.notes);
  const auto predict = [surrogate, threads = context.control.threads](const Eigen::MatrixXd& features,
                                                                      const Eigen::MatrixXd& inputs) {
    return surrogate->predict(features, inputs, threads);
  };
  return {"surrogate",
          predict,
          surrogate->validation.residual_correlation,
          fitTransform(context.experiment.transform, context.labelled.train),
          std::move(training.summary),
          std::move(training.notes),
          std::move(online.model),
          {}};
}

TrainedMap trainChosenMap(const MapTrainingContext& context) {
  const InverseMapSpec& spec = context.experiment.inverse_map;
  if (spec.isAutomatic()) {
    return trainAutomatically(context);
  }
  if (spec.findNetwork() != nullptr) {
    return trainNeurally(context);
  }
  return spec.findGp() != nullptr ? trainProcesses(context) : trainForward(context);
}

}  // namespace twinmap
