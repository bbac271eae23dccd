#include "framework/experiment/train_surrogate_map.hpp"

#include <limits>
#include <stdexcept>

#include "framework/experiment/train_interruptibly.hpp"
#include "framework/monitoring/stage_timer.hpp"
#include "framework/surrogate/train_surrogate.hpp"

namespace twinmap {
namespace {

SurrogateTraining train(const ModelSpec& model, const SurrogateSamples& samples,
                        const TrainingControl& control) {
  try {
    return trainInterruptibly([&] { return trainSurrogate(model, samples, control); });
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("the surrogate cannot be trained: ") + error.what());
  }
}

}  // namespace

SurrogateMapTraining trainSurrogateMap(const ExperimentSpec& experiment, const SimulatedSets& sets,
                                       const FeatureExtractor& extractor, const LabelledFeatures& samples,
                                       const RunControl& control) {
  const std::vector<int> successful = findSuccessful(sets.train);
  const SurrogateSamples simulated{samples.infos, sets.train.parameters(Eigen::all, successful),
                                   extractor.extract(sets.train.responses(Eigen::all, successful)),
                                   samples.noise_covariance, samples.features};
  SurrogateMapTraining training;
  SurrogateTraining trained = timeStage("train the surrogate", training.notes, [&] {
    return train(experiment.model, simulated, {control.threads, control.abandon});
  });
  training.notes.warn(Gravity::kPoor, trained.warnings);
  const SurrogateValidation& validation = trained.surrogate.validation;
  training.summary.leave_one_out = calcMetrics(experiment.model.parameters, trained.held_out_truth,
                                               trained.held_out, {}, trained.held_out_draws);
  training.summary.nlml.assign(experiment.model.parameters.size(), std::numeric_limits<double>::quiet_NaN());
  training.summary.cross_validation = CrossValidation{validation.coverage95, validation.stddev_scale,
                                                      validation.log_density, toString(validation.status)};
  training.surrogate = std::move(trained.surrogate);
  return training;
}

}  // namespace twinmap
