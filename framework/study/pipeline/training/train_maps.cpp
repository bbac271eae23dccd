#include "framework/study/pipeline/training/train_maps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <memory>

#include "framework/base/log/log.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/study/pipeline/training/fit_online.hpp"
#include "framework/study/pipeline/training/train_interruptibly.hpp"

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

namespace {

std::string join(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) {
    joined += (joined.empty() ? "" : "; ") + text;
  }
  return joined;
}

std::vector<TrainingStart> summarizeTraining(const std::vector<std::string>& parameters,
                                             const std::vector<gp::TrainingReport>& reports) {
  std::vector<TrainingStart> rows;
  for (std::size_t p = 0; p < reports.size(); ++p) {
    for (std::size_t k = 0; k < reports[p].starts.size(); ++k) {
      const gp::StartReport& start = reports[p].starts[k];
      const bool best = static_cast<int>(k) == reports[p].best_start;
      rows.push_back({parameters[p], static_cast<int>(k), best, start.nlml, start.evaluations,
                      start.noise_only, start.stop_reason, best ? join(reports[p].at_bound) : "",
                      reports[p].condition, reports[p].jitter});
    }
  }
  return rows;
}

std::vector<TrainedHyperparameter> listHyperparameters(const std::vector<std::string>& parameters,
                                                       const std::vector<gp::TrainingReport>& reports) {
  std::vector<TrainedHyperparameter> listed;
  for (std::size_t p = 0; p < reports.size(); ++p) {
    for (const gp::BoundedHyperparameter& of : reports[p].hyperparameters) {
      listed.push_back({parameters[p], of.name, of.value, of.lower, of.upper});
    }
  }
  return listed;
}

}  // namespace

Training makeTraining(const ExperimentSpec& experiment, const LabelledFeatures& samples,
                      GpMapTraining trained) {
  const std::vector<std::string> names = collectNames(experiment.model.parameters);
  Training training;
  for (const std::string& warning : trained.warnings) {
    training.notes.warn(makeWarning(Notice::kUnfinishedTraining, warning));
  }
  training.summary.leave_one_out = calcMetrics(experiment.model.parameters, samples.parameters,
                                               trained.leave_one_out, {}, samples.replicates);
  training.summary.starts = summarizeTraining(names, trained.reports);
  training.summary.hyperparameters = listHyperparameters(names, trained.reports);
  for (const gp::Process& process : trained.map.processes) {
    training.summary.nlml.push_back(gp::getNlml(process));
  }
  training.map = std::move(trained.map);
  return training;
}

Training trainMap(const Study& study, const LabelledFeatures& samples) {
  const ExperimentSpec& experiment = study.experiment;
  StageNotes notes;
  GpMapTraining trained = timeStage("train the inverse map", notes, [&] {
    return trainInterruptibly([&] {
      return trainGpMap(*experiment.inverse_map.findProcesses(), experiment.transform,
                        collectNames(experiment.model.parameters), samples, study.getTrainingControl(),
                        experiment.model.inputs);
    });
  });
  Training training = makeTraining(experiment, samples, std::move(trained));
  training.notes.times = notes.times;
  return training;
}

}  // namespace twinmap
