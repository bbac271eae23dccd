#include "framework/study/pipeline/training/train_surrogate_map.hpp"

#include <limits>
#include <stdexcept>

#include "framework/base/log/stage_timer.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/study/pipeline/training/train_interruptibly.hpp"

namespace twinmap {
namespace {

SurrogateTraining trainOn(const ModelSpec& model, const SurrogateSamples& samples,
                          const TrainingControl& control) {
  try {
    return trainInterruptibly([&] { return trainSurrogate(model, samples, control); });
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("the surrogate cannot be trained: ") + error.what());
  }
}

/// Slopes at the first training points, of which the surrogate takes no more; none where a simulation with
/// derivatives fails.
std::vector<Eigen::MatrixXd> simulateSlopes(const Study& study, const Eigen::MatrixXd& points) {
  const std::vector<ParameterSpec> unknown = collectUnknown(study.experiment.model);
  const Eigen::Index count = countSlopePoints(points.cols(), static_cast<Eigen::Index>(unknown.size()));
  std::vector<Eigen::MatrixXd> slopes(static_cast<std::size_t>(points.cols()));
  const std::vector<LocalModel> local = calcLocalModels(study.simulator, study.extractor, unknown,
                                                        points.leftCols(count), study.control.threads);
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (local[i].status.ok) {
      slopes[i] = local[i].sensitivities;
    }
  }
  return slopes;
}

}  // namespace

SurrogateMapTraining trainSurrogateMap(const Study& study, const PreparedData& data) {
  const Trajectories& train = data.sets.train;
  const LabelledFeatures& samples = data.labelled.train;
  const std::vector<int> successful = findSuccessful(train);
  SurrogateSamples simulated{samples.infos, train.parameters(Eigen::all, successful),
                             study.extractor.extract(train.responses(Eigen::all, successful)),
                             samples.noise_covariance, samples.features};
  SurrogateMapTraining training;
  if (study.simulator.hasDerivatives()) {
    simulated.slopes = timeStage("compute parameter sensitivities of the training samples", training.notes,
                                 [&] { return simulateSlopes(study, simulated.points); });
  }
  SurrogateTraining trained = timeStage("train the surrogate", training.notes, [&] {
    return trainOn(study.experiment.model, simulated, study.getTrainingControl());
  });
  training.notes.warn(Severity::kDegraded, trained.warnings);
  const SurrogateValidation& validation = trained.surrogate.validation;
  training.summary.leave_one_out = calcMetrics(study.experiment.model.parameters, trained.held_out_truth,
                                               trained.held_out, {}, trained.held_out_draws);
  training.summary.nlml.assign(study.experiment.model.parameters.size(),
                               std::numeric_limits<double>::quiet_NaN());
  training.summary.cross_validation = CrossValidation{validation.coverage95,
                                                      validation.stddev_scale,
                                                      validation.log_density,
                                                      toString(validation.status),
                                                      validation.limit_ratio,
                                                      static_cast<int>(trained.gain.half),
                                                      static_cast<int>(trained.gain.all),
                                                      trained.gain.error_ratio};
  training.surrogate = std::move(trained.surrogate);
  training.typical_stddev = calcTypicalStddev(trained.held_out.stddev);
  return training;
}

}  // namespace twinmap
