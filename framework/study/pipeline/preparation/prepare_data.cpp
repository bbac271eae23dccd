#include "framework/study/pipeline/preparation/prepare_data.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/data/noise/noise.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/prior.hpp"
#include "framework/study/samples/stencils.hpp"

namespace twinmap {
namespace {

/// The features of one draw of the noise; all samples take part, so that none changes another's noise.
Eigen::MatrixXd drawFeatures(const Trajectories& trajectories, const FeatureExtractor& extractor,
                             const ResponseNoise& noise, const RandomStream& random, int replicate) {
  return extractor.extract(addNoise(trajectories.responses, noise, random, replicate));
}

/// Fails the samples that are ok and lack a feature; `where` completes the reason.
void failWhereMissing(const Eigen::MatrixXd& features, const std::vector<FeatureInfo>& infos,
                      const std::string& where, std::vector<SampleStatus>& statuses) {
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    for (Eigen::Index row = 0; row < features.rows() && statuses[i].ok; ++row) {
      if (!std::isfinite(features(row, i))) {
        statuses[i] = {false, "feature '" + infos[row].name + "' is missing in the " + where};
      }
    }
  }
}

void failIncomplete(const FeatureExtractor& extractor, const ResponseNoise& noise, const RandomStream& random,
                    int replicates, Trajectories& trajectories) {
  failWhereMissing(extractor.extract(trajectories.responses), extractor.getInfos(), "response",
                   trajectories.statuses);
  for (int r = 0; r < replicates; ++r) {
    failWhereMissing(drawFeatures(trajectories, extractor, noise, random, r), extractor.getInfos(),
                     "response with noise (draw " + std::to_string(r + 1) + ")", trajectories.statuses);
  }
}

/// Splits points of the sampled box by the role of each parameter.
void setPoints(const ModelSpec& model, const Eigen::MatrixXd& points, LabelledFeatures& labelled) {
  const auto p = static_cast<Eigen::Index>(model.parameters.size());
  labelled.parameters = points.topRows(p);
  labelled.nuisance = points.middleRows(p, static_cast<Eigen::Index>(model.nuisance.size()));
  labelled.inputs = points.bottomRows(static_cast<Eigen::Index>(model.inputs.size()));
}

LabelledFeatures makeLabelledFeatures(const ModelSpec& model, const Trajectories& trajectories,
                                      const FeatureExtractor& extractor, const ResponseNoise& noise,
                                      const RandomStream& random, int replicates) {
  const std::vector<int> samples = findSuccessful(trajectories);
  const auto count = static_cast<Eigen::Index>(samples.size());
  LabelledFeatures labelled;
  labelled.infos = extractor.getInfos();
  labelled.features.resize(extractor.getFeatureCount(), count * replicates);
  for (int r = 0; r < replicates; ++r) {
    Eigen::MatrixXd drawn = drawFeatures(trajectories, extractor, noise, random, r);
    if (drawn.cols() == labelled.features.cols()) {  // no copy of what may be large
      labelled.features = std::move(drawn);
    } else {
      labelled.features.middleCols(r * count, count) = drawn(Eigen::all, samples);
    }
  }
  setPoints(model, Eigen::MatrixXd(trajectories.parameters(Eigen::all, samples)).replicate(1, replicates),
            labelled);
  labelled.replicates = replicates;
  return labelled;
}

std::vector<Eigen::MatrixXd> calcTrainingSensitivities(const Study& study, const Trajectories& train) {
  if (!selectsByFisherInformation(study.experiment)) {
    return {};
  }
  std::vector<int> samples = findSuccessful(train);
  samples.resize(std::min<std::size_t>(samples.size(), kSensitivitySamples));
  std::vector<Eigen::MatrixXd> sensitivities;
  for (const LocalModel& local : calcLocalModels(study, train.parameters(Eigen::all, samples))) {
    if (local.status.ok) {
      sensitivities.push_back(local.sensitivities);
    }
  }
  if (sensitivities.empty()) {
    throw std::runtime_error("select by fisher_information: the features' sensitivities cannot be simulated");
  }
  return sensitivities;
}

Eigen::MatrixXd calcMeanPriorInformation(const ModelSpec& model, const LabelledFeatures& samples) {
  const Prior prior(collectUnknown(model), model.priors);
  Eigen::MatrixXd sum;
  for (const Eigen::MatrixXd& one : prior.calcInformation(samples.collectUnknown())) {
    sum = sum.size() == 0 ? one : Eigen::MatrixXd(sum + one);
  }
  return sum / static_cast<double>(samples.parameters.cols());
}

}  // namespace

SimulatedSets failIncompleteSamples(const ExperimentSpec& experiment, const FeatureExtractor& extractor,
                                    SimulatedSets sets) {
  if (extractor.isLinear()) {
    return sets;
  }
  const ResponseNoise response_noise(experiment.noise, sets.train.layout);
  failIncomplete(extractor, response_noise, {experiment.seed, RandomPurpose::kTrainNoise},
                 experiment.noise.replicates.value_or(1), sets.train);
  failIncomplete(extractor, response_noise, {experiment.seed, RandomPurpose::kTestNoise}, 1, sets.test);
  return sets;
}

LabelledSets makeLabelledSets(const ExperimentSpec& experiment, const SimulatedSets& sets,
                              const FeatureExtractor& extractor, const FeatureNoise& noise) {
  const ResponseNoise response_noise(experiment.noise, sets.train.layout);
  LabelledSets labelled{makeLabelledFeatures(experiment.model, sets.train, extractor, response_noise,
                                             {experiment.seed, RandomPurpose::kTrainNoise},
                                             experiment.noise.replicates.value_or(1)),
                        makeLabelledFeatures(experiment.model, sets.test, extractor, response_noise,
                                             {experiment.seed, RandomPurpose::kTestNoise}, 1)};
  const Trajectories& clean = experiment.inverse_map.isNone() ? sets.test : sets.train;
  labelled.train.noise_covariance =
      noise.calcMeanCovariance(clean.responses(Eigen::all, findSuccessful(clean)));
  labelled.test.noise_covariance = labelled.train.noise_covariance;
  return labelled;
}

PreparedData prepareData(const Study& study, SimulatedSets sets) {
  PreparedData data{std::move(sets), {}, {}};
  data.test_indices = findSuccessful(data.sets.test);
  data.labelled = makeLabelledSets(study.experiment, data.sets, study.extractor, study.noise);
  data.labelled.train.sensitivities = calcTrainingSensitivities(study, data.sets.train);
  if (!data.labelled.train.sensitivities.empty()) {
    data.labelled.train.prior_information =
        calcMeanPriorInformation(study.experiment.model, data.labelled.train);
  }
  return data;
}

}  // namespace twinmap
