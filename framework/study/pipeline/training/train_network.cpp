#include "framework/study/pipeline/training/train_network.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "framework/base/log/log.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/network/train_network_map.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "framework/experiment/network_size.hpp"
#include "framework/study/pipeline/training/train_interruptibly.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kMuchExcess = 1.1;  // beyond it a longer training is worth its minute

const NetworkMapSpec& getSpec(const Study& study) {
  return *study.experiment.inverse_map.findNetwork();
}

int countSimulations(const LabelledFeatures& samples) {
  return static_cast<int>(samples.features.cols() / samples.replicates);
}

/// Why no surrogate is to be tried; empty if one is.
std::string findReasonForSimulations(const Study& study, const PreparedData& data) {
  const int n = countSimulations(data.labelled.train);
  if (getSpec(study).samples_from == NetworkSamples::kSimulations) {
    return "asked for";
  }
  if (getSpec(study).samples_from == NetworkSamples::kSurrogate) {
    return "";
  }
  if (getSpec(study).bayesian == NetworkBayes::kHamiltonian) {
    return "a Hamiltonian sampler draws weights given the simulations";
  }
  if (!getSpec(study).mayLearnFromSurrogate(n)) {
    return fmt::format("a surrogate takes no more than {} of {} simulations", NetworkMapSpec::kMaxOfSurrogate,
                       n);
  }
  return findSurrogateObstacle(study.experiment.model, n, data.labelled.train.noise_covariance);
}

/// The surrogate to learn from, if there is to be one.
std::optional<SurrogateMapTraining> findTeacher(const Study& study, const PreparedData& data,
                                                StageNotes& notes) {
  const std::string reason = findReasonForSimulations(study, data);
  if (!reason.empty()) {
    logInfo(fmt::format("the network is trained on the simulations: {}", reason));
    return std::nullopt;
  }
  SurrogateMapTraining teacher = trainSurrogateMap(study, data);
  notes.append(teacher.notes);
  logInfo(
      fmt::format("the network is trained on surrogate samples (predicted sd / information limit: {:.2f})",
                  teacher.surrogate.validation.limit_ratio.maxCoeff()));
  return teacher;
}

/// Tells where many simulations, which take next to nothing in lanes, may teach the network more than the
/// surrogate does. Networks of 10000 simulations were nearer to the limit where surrogates of 250 promised
/// 2.4 to 7.7 times it. These were four storeys, top, chain and chaotic pendulum. One of two was nearer where
/// they promised 1.8 (end stops, not the arm).
void suggestSimulations(const Surrogate& teacher, const Study& study, StageNotes& notes) {
  constexpr double kFar = 2.0;
  constexpr int kMany = 10000;
  const double ratio = teacher.validation.limit_ratio.maxCoeff();
  if (ratio > kFar && study.simulator.getEngine() == "lanes") {
    notes.warn(makeWarning(Notice::kTeacherFar, ratio, kMany));
  }
}

/// The network's standard deviations over those of the surrogate that taught it (p), typically.
Eigen::VectorXd calcExcess(const NetworkMapTraining& trained, const SurrogateMapTraining& teacher) {
  return calcTypicalStddev(trained.held_out.stddev).cwiseQuotient(teacher.typical_stddev);
}

/// Tells where the network has not learnt all that the surrogate could teach it.
void remarkOnStudent(const Eigen::VectorXd& excess, const ModelSpec& model, StageNotes& notes) {
  Index worst = 0;
  if (excess.maxCoeff(&worst) > kMuchExcess) {
    notes.warn(makeWarning(Notice::kStudentFar, model.parameters[static_cast<std::size_t>(worst)].name.text,
                           excess[worst]));
  }
}

/// Enough columns for a transform.
LabelledFeatures takeFirst(const LabelledFeatures& samples) {
  constexpr Index kMax = 20000;
  if (samples.features.cols() <= kMax) {
    return samples;
  }
  LabelledFeatures first{samples.infos,
                         samples.features.leftCols(kMax),
                         samples.parameters.leftCols(kMax),
                         samples.noise_covariance,
                         1,
                         samples.sensitivities};
  first.nuisance = samples.nuisance.leftCols(kMax);
  first.inputs = samples.inputs.leftCols(kMax);
  first.prior_information = samples.prior_information;
  return first;
}

NetworkMapTraining trainOnSimulations(const Study& study, const PreparedData& data,
                                      const FeatureTransform& transform) {
  const NetworkMapSpec spec = completeSize(getSpec(study), NetworkSize::kSmall);
  const std::vector<int> successful = findSuccessful(data.sets.train);
  const MatrixXd points = data.sets.train.parameters(Eigen::all, successful);
  const MatrixXd responses = data.sets.train.responses(Eigen::all, successful);
  const ResponseNoise noise(study.experiment.noise, data.sets.train.layout);
  return trainNetworkMap({study.experiment.model, spec, study.experiment.seed},
                         {points, responses, study.extractor, noise, transform, study.extractor.isLinear(),
                          data.labelled.train.noise_covariance},
                         study.getTrainingControl());
}

NetworkMapTraining teach(const Study& study, const SurrogatePool& pool, NetworkSize size) {
  const NetworkMapSpec spec = completeSize(getSpec(study), size);
  return trainNetworkMap({study.experiment.model, spec, study.experiment.seed}, pool,
                         study.getTrainingControl());
}

/// A small network, or a medium one where that has not learnt all that the surrogate could teach it, unless a
/// size is given or there would be five of them.
NetworkMapTraining trainOnSurrogate(const Study& study, const SurrogateMapTraining& teacher) {
  const SurrogatePool pool =
      makeSurrogatePool(teacher.surrogate, study.experiment.model, getSpec(study).surrogate_samples,
                        study.experiment.seed, study.getTrainingControl());
  NetworkMapTraining small = teach(study, pool, NetworkSize::kSmall);
  const double excess = calcExcess(small, teacher).maxCoeff();
  if (excess <= kMuchExcess || hasSize(getSpec(study)) || getSpec(study).bayesian != NetworkBayes::kNone) {
    return small;
  }
  logInfo(fmt::format(
      "the network learns from the surrogate for longer: its standard deviations are up to {:.1f} "
      "times the surrogate's",
      excess));
  NetworkMapTraining longer = teach(study, pool, NetworkSize::kMedium);
  return calcExcess(longer, teacher).maxCoeff() < excess ? std::move(longer) : std::move(small);
}

NetworkMapTraining trainBy(const Study& study, const PreparedData& data, const FeatureTransform& transform,
                           const std::optional<SurrogateMapTraining>& teacher) {
  try {
    return trainInterruptibly([&] {
      return teacher ? trainOnSurrogate(study, *teacher) : trainOnSimulations(study, data, transform);
    });
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("the network cannot be trained: ") + error.what());
  }
}

/// Names of the quantities that chains were followed for.
SampledChains describeChains(const ModelSpec& model, const WeightChains& found) {
  SampledChains sampled;
  for (std::size_t p = 0; p < found.means.size(); ++p) {
    sampled.quantities.push_back(
        {model.parameters[p].name.text, found.means[p].r_hat, found.means[p].effective_sample_size});
  }
  sampled.quantities.push_back(
      {"log density", found.log_density.r_hat, found.log_density.effective_sample_size});
  sampled.chains = found.chains;
  sampled.draws = found.draws;
  sampled.divergences = found.divergences;
  sampled.cut = found.cut;
  sampled.acceptance = found.mean_acceptance;
  sampled.weights = static_cast<int>(found.weights);
  return sampled;
}

TrainingSummary summarizeNetwork(const ModelSpec& model, const NetworkMapTraining& trained) {
  const SurrogateValidation& validation = trained.map.validation;
  TrainingSummary summary;
  summary.leave_one_out =
      calcMetrics(model.parameters, trained.held_out_truth, trained.held_out, {}, trained.held_out_draws);
  summary.nlml.assign(model.parameters.size(), std::numeric_limits<double>::quiet_NaN());
  CrossValidation found;
  found.coverage95 = validation.coverage95;
  found.stddev_scale = validation.stddev_scale;
  found.log_density = validation.log_density;
  found.status = toString(validation.status);
  found.limit_ratio = validation.limit_ratio;
  found.interval_factors = validation.interval_factors;
  summary.cross_validation = std::move(found);
  if (trained.chains) {
    summary.chains = describeChains(model, *trained.chains);
  }
  return summary;
}

}  // namespace

NetworkOutcome trainNetwork(const Study& study, const PreparedData& data) {
  NetworkOutcome outcome;
  const std::optional<SurrogateMapTraining> teacher = findTeacher(study, data, outcome.notes);
  outcome.transform = fitTransform(study.experiment.transform, takeFirst(data.labelled.train));
  NetworkMapTraining trained = timeStage("train the network", outcome.notes,
                                         [&] { return trainBy(study, data, outcome.transform, teacher); });
  outcome.notes.warn(Severity::kDegraded, trained.warnings);
  if (teacher) {
    const Eigen::VectorXd excess = calcExcess(trained, *teacher);
    trained.map.validation.limit_ratio = excess.cwiseProduct(teacher->surrogate.validation.limit_ratio);
    remarkOnStudent(excess, study.experiment.model, outcome.notes);
    outcome.forward = teacher->surrogate.forward;
    suggestSimulations(teacher->surrogate, study, outcome.notes);
  }
  outcome.summary = summarizeNetwork(study.experiment.model, trained);
  outcome.map = std::move(trained.map);
  return outcome;
}

}  // namespace twinmap
