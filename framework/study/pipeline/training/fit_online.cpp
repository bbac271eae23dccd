#include "framework/study/pipeline/training/fit_online.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/log/notice.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"
#include "framework/estimation/trained/fit_trust.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/study/pipeline/training/train_interruptibly.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Columns whose features are all there; a noise draw may have lost one.
std::vector<Index> findComplete(const MatrixXd& features) {
  std::vector<Index> complete;
  for (Index i = 0; i < features.cols(); ++i) {
    if (features.col(i).allFinite()) {
      complete.push_back(i);
    }
  }
  return complete;
}

/// How many test responses are judged: as many as place half of the level, which each of two tests has, to a
/// third. More make no better reference, and each takes as long as an inference.
int calcMostReferences(double level) {
  constexpr double kBeyond = 10.0;
  return static_cast<int>(std::ceil(std::min(kBeyond / (0.5 * level), 1e9)));
}

/// Of each of so many test responses.
int countDraws(int train_samples, int responses) {
  // a thousand place the 1 % quantile to a third of it
  constexpr int kMin = 200, kMax = 1000, kPerSimulation = 10;
  const int wanted = std::clamp(train_samples, kMin / kPerSimulation, kMax / kPerSimulation) * kPerSimulation;
  return std::max(1, wanted / std::max(1, responses));
}

/// Test responses, each with several draws of the noise where they are few.
void simulateMeasurements(const Study& study, const Trajectories& test, TrustTraining& training) {
  const ExperimentSpec& experiment = study.experiment;
  std::vector<int> samples = findSuccessful(test);
  samples.resize(
      std::min(samples.size(), static_cast<std::size_t>(calcMostReferences(experiment.trust.level))));
  const MatrixXd responses = test.responses(Eigen::all, samples);
  const int draws = countDraws(experiment.design.train.samples, static_cast<int>(samples.size()));
  const ResponseNoise noise(experiment.noise, test.layout);
  const RandomStream random(experiment.seed, RandomPurpose::kTrust);
  MatrixXd measured(study.extractor.getFeatureCount(), responses.cols() * draws);
  for (int r = 0; r < draws; ++r) {
    measured.middleCols(r * responses.cols(), responses.cols()) =
        study.extractor.extract(addNoise(responses, noise, random, r));
  }
  const std::vector<Index> complete = findComplete(measured);
  const auto known = static_cast<Index>(experiment.model.inputs.size());
  const MatrixXd inputs =
      MatrixXd(test.parameters(Eigen::all, samples).bottomRows(known)).replicate(1, draws);
  training.measured = measured(Eigen::all, complete);
  training.known = inputs(Eigen::all, complete);
}

TrustTraining makeTrustTraining(const Study& study, const PreparedData& data) {
  constexpr std::size_t kMaxSimulations = 500;
  const ExperimentSpec& experiment = study.experiment;
  const Trajectories& train = data.sets.train;
  std::vector<int> samples = findSuccessful(train);
  samples.resize(std::min(samples.size(), kMaxSimulations));
  TrustTraining training;
  training.seed = experiment.seed;
  training.sampled = collectSampled(experiment.model);
  training.prior = makeBoxPrior(experiment.model);
  training.infos = study.extractor.getInfos();
  training.points = train.parameters(Eigen::all, samples);
  training.clean_features = study.extractor.extract(train.responses(Eigen::all, samples));
  training.noise_covariance = data.labelled.train.noise_covariance;
  simulateMeasurements(study, data.sets.test, training);
  return training;
}

ForwardSurrogate fitSurrogate(const TrustTraining& training, const TrainingControl& control) {
  const Eigen::VectorXd center = calcBoxCenter(training.sampled);
  const Eigen::VectorXd half_width = 0.5 * calcWidths(training.sampled);
  const MatrixXd normalized = half_width.cwiseInverse().asDiagonal() * (training.points.colwise() - center);
  return fitForward({training.infos, normalized, training.clean_features, training.noise_covariance}, {},
                    control)
      .surrogate;
}

}  // namespace

OnlineFit fitOnline(const Study& study, const PreparedData& data, std::shared_ptr<const Estimator> map,
                    std::shared_ptr<const ForwardSurrogate> forward) {
  OnlineFit fit{{std::move(map), {}}};
  if (forward == nullptr) {
    forward = fit.model.map->findForward();
  }
  try {
    const TrustTraining training = makeTrustTraining(study, data);
    fit.model.trust = trainInterruptibly([&] {
      if (forward == nullptr) {
        forward =
            std::make_shared<const ForwardSurrogate>(fitSurrogate(training, study.getTrainingControl()));
      }
      return fitTrustModel(training, forward, *fit.model.map, study.experiment.trust.level,
                           study.getTrainingControl());
    });
  } catch (const std::invalid_argument& error) {
    fit.notes.warn(makeWarning(Notice::kNoTrustModel, error.what()));
  }
  return fit;
}

int countReferences(const ExperimentSpec& experiment) {
  const int responses =
      std::min<int>(experiment.design.test.samples, calcMostReferences(experiment.trust.level));
  return responses * countDraws(experiment.design.train.samples, responses);
}

}  // namespace twinmap
