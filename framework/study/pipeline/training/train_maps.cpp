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
OnlineFit prepareOnline(const Study& study, const PreparedData& data, const Map&... map) {
  StageNotes notes;
  OnlineFit online =
      timeStage("calibrate the goodness-of-fit test", notes, [&] { return fitOnline(study, data, map...); });
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
  OnlineFit online = prepareOnline(study, data, map, outcome.forward);
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

}  // namespace

TrainedMap makeTrainedMap(const Study& study, const PreparedData& data, Training training) {
  OnlineFit online = prepareOnline(study, data, training.map);
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
  OnlineFit online = prepareOnline(study, data, surrogate);
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
  const InverseMapSpec& spec = study.experiment.inverse_map;
  if (spec.isAutomatic()) {
    return trainAutomatically(study, data);
  }
  if (spec.findNetwork() != nullptr) {
    return trainNeurally(study, data);
  }
  return spec.findGp() != nullptr ? trainProcesses(study, data) : trainForward(study, data);
}

}  // namespace twinmap
