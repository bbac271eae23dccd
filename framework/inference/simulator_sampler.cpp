#include "framework/inference/simulator_sampler.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/log/search_stage.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/noise/noise_candidates.hpp"
#include "framework/estimation/ridges/simulated_ridges.hpp"
#include "framework/experiment/points/prior.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Draws that stand for the posterior, each once at most: where the sum of the weights passes equal steps.
std::vector<Index> chooseDraws(const VectorXd& weights) {
  std::vector<Index> chosen;
  double passed = 0.0;
  for (Index i = 0; i < weights.size(); ++i) {
    const double before = passed;
    passed += weights[i];
    if (std::floor(passed * static_cast<double>(kStandingDraws) + 0.5) >
        std::floor(before * static_cast<double>(kStandingDraws) + 0.5)) {
      chosen.push_back(i);
    }
  }
  return chosen;
}

/// Whether a fit under another hypothesis of the noise explains a measurement.
bool explains(const SimulatorFit& fit, Index residuals) {
  constexpr double kMaxOutliers = 0.05;  // of the samples
  const bool is_physics = std::any_of(fit.noise.begin(), fit.noise.end(), [](const NoiseReport& report) {
    return report.isStated() && report.found.autoregression.size() > 0 && isLargerThanStated(report.found);
  });
  return fit.isPlausible() && !is_physics &&
         static_cast<double>(fit.outliers.size()) <= kMaxOutliers * static_cast<double>(residuals);
}

}  // namespace

SimulatorPosteriorOptions makePosteriorOptions(const ExperimentSpec& experiment, int draws) {
  if (draws < kMinPosteriorDraws) {
    throw ExperimentError(
        fmt::format("a posterior needs at least {} draws, not {}", kMinPosteriorDraws, draws));
  }
  SimulatorPosteriorOptions options;
  options.draws = draws;
  options.seed = experiment.seed;
  return options;
}

SimulatorPosteriorOptions searchNearby(SimulatorPosteriorOptions options) {
  constexpr int kOwnStarts = 8;
  options.search.scouts = kOwnStarts;
  options.search.starts = 2 * kOwnStarts;
  options.search.max_batches = 1;
  return options;
}

SampledMeasurement SimulatorSampler::sampleUnder(const NoiseHypothesis& noise, const VectorXd& features,
                                                 const VectorXd& known, const MatrixXd& given,
                                                 const SimulatorPosteriorOptions& options) const {
  const auto u = static_cast<Index>(getUnknown().size());
  PosteriorProblem problem{getUnknown(), getModelSpec().priors, {makeTrial(features, known)}, u};
  problem.trials.front().noise = noise;
  SampledMeasurement sampled{noise, twinmap::samplePosterior(problem, given, options), {}};
  sampled.estimate = makeEstimate(problem.trials.front(), sampled.posterior);
  return sampled;
}

SampledMeasurement SimulatorSampler::sampleAsStated(const VectorXd& features, const VectorXd& known,
                                                    const NoiseHypothesis& stated, const MatrixXd& given,
                                                    const SimulatorPosteriorOptions& options) const {
  const bool is_known = stated.outputs.empty();
  SampledMeasurement sampled =
      sampleUnder(is_known ? stated : guessSizes(stated, *makeTrial(features, known).model, features),
                  features, known, given, options);
  if (!is_known && sampled.estimate.fit->isSimulated()) {
    sampled = sampleUnder(stated, features, known, sampled.posterior.best, options);
  }
  return sampled;
}

SampledMeasurement SimulatorSampler::samplePosterior(const VectorXd& features, const VectorXd& known,
                                                     const NoiseHypothesis& stated, const MatrixXd& given,
                                                     const SimulatorPosteriorOptions& options) const {
  return explainByNoise(sampleAsStated(features, known, stated, given, spareMisfit(options)), features, known,
                        stated, options);
}

SampledMeasurement SimulatorSampler::explainByNoise(SampledMeasurement sampled, const VectorXd& features,
                                                    const VectorXd& known, const NoiseHypothesis& stated,
                                                    const SimulatorPosteriorOptions& options) const {
  const SimulatorFit& fit = *sampled.estimate.fit;
  if (!fit.isSimulated() || fit.isPlausible() || !readsOutputs()) {
    return sampled;
  }
  std::vector<NoiseHypothesis> others = listNoise(stated, features, known, fit.best);
  SimulatorPosteriorOptions sparing = searchNearby(spareMisfit(options));
  sparing.search.settles = true;  // a hypothesis whose best fit it does not explain is none
  if (fit.isGross()) {            // no noise is so large, but a few samples may be off
    others.erase(std::remove_if(others.begin(), others.end(),
                                [](const NoiseHypothesis& noise) {
                                  return noise.has_outliers && !noise.outputs.empty();
                                }),
                 others.end());
  }
  sparing.wants_draws = [&](const SimulatorPosterior& found) {
    return explains(*makeEstimate(makeTrial(features, known), found).fit, fit.residual.size());
  };
  const SearchStage stage = SearchStage::supposing("does another noise explain it");
  for (const NoiseHypothesis& noise : others) {
    SampledMeasurement other = sampleUnder(noise, features, known, fit.best, sparing);
    if (other.estimate.isReliable()) {
      return other;
    }
  }
  return sampled;
}

SimulatorPosteriorOptions SimulatorSampler::spareMisfit(SimulatorPosteriorOptions options) const {
  options.spares_misfit = readsOutputs();
  return options;
}

double SimulatorSampler::findLeastChiSquare(const VectorXd& features, const VectorXd& known,
                                            Index all) const {
  const auto there = static_cast<double>(features.array().isFinite().count()), of = static_cast<double>(all);
  if (2.0 * there <= of) {
    return std::numeric_limits<double>::infinity();
  }
  return of / there * findLeastMisfit(features, known).chi_square;
}

LeastMisfit SimulatorSampler::findLeastMisfit(const VectorXd& features, const VectorXd& known,
                                              const MatrixXd& given) const {
  return twinmap::findLeastMisfit({getUnknown(),
                                   getModelSpec().priors,
                                   {makeTrial(features, known)},
                                   static_cast<Index>(getUnknown().size())},
                                  given);
}

PosteriorEstimate SimulatorSampler::makeEstimate(const MeasuredTrial& trial,
                                                 SimulatorPosterior posterior) const {
  std::vector<FeatureInfo> infos = getExtractor().getInfos();
  if (trial.own_model) {
    infos.clear();
    for (const Index i : trial.own_model->getWhole().features) {
      infos.push_back(trial.own_model->getExtractor().getInfos()[static_cast<std::size_t>(i)]);
    }
  } else if (posterior.degrees > 0.0) {
    posterior.standardized.residual = getModel().placeResidual(posterior.standardized.residual);
  }
  PosteriorEstimate made = makePosteriorEstimate(posterior, getUnknown(),
                                                 static_cast<Index>(getModelSpec().parameters.size()), infos);
  nameNoise(made.fit->noise);
  if (trial.own_model) {
    for (Index& feature : made.fit->outlier_features) {
      feature = trial.own_model->getWhole().features[static_cast<std::size_t>(feature)];
    }
  }
  return made;
}

PosteriorEstimate SimulatorSampler::makeFailed(const VectorXd& features, const VectorXd& known,
                                               const std::string& reason) const {
  SimulatorPosterior posterior;
  posterior.message = reason;
  return makeEstimate(makeTrial(features, known), std::move(posterior));
}

bool SimulatorSampler::readsOutputs() const {
  const std::vector<OutputSpec>& outputs = getModelSpec().outputs;
  const std::vector<std::string>& read = getSimulator().getLayout().output_names;
  return std::all_of(read.begin(), read.end(), [&](const std::string& name) {
    return std::any_of(outputs.begin(), outputs.end(),
                       [&](const OutputSpec& output) { return output.name.text == name; });
  });
}

std::vector<NoiseHypothesis> SimulatorSampler::listNoise(const NoiseHypothesis& stated,
                                                         const VectorXd& features, const VectorXd& known,
                                                         const VectorXd& best) const {
  const MeasuredTrial trial = makeTrial(features, known);
  const LocalMisfit local = TrialMisfit(trial).linearize(best);
  if (!local.status.ok) {
    return {};
  }
  return listNoiseHypotheses(stated, {trial.model, local.residual, local.jacobian});
}

std::optional<LinearizedMeasurement> SimulatorSampler::linearize(const VectorXd& features,
                                                                 const VectorXd& known,
                                                                 const VectorXd& best) const {
  const MeasuredTrial trial = makeTrial(features, known);
  LocalMisfit local = TrialMisfit(trial).linearize(best);
  if (!local.status.ok) {
    return std::nullopt;
  }
  const GrowingWindow& whole = trial.model->getWhole();
  return LinearizedMeasurement{std::move(local.residual), std::move(local.jacobian), whole.features,
                               whole.whitener};
}

MatrixXd SimulatorSampler::listRidgePoints(const PosteriorEstimate& posterior) const {
  const BoundedDraws& draws = posterior.estimate.draws;
  if (!draws.isGiven()) {
    return posterior.places;
  }
  const bool may_have = !Prior(getUnknown(), getModelSpec().priors).isUniform() ||
                        mayHaveRidges(draws, getModelSpec().parameters);
  if (!may_have) {
    return {};
  }
  MatrixXd chosen = draws.points(Eigen::all, chooseDraws(draws.weights));
  if (!posterior.fit || posterior.fit->best.size() != chosen.rows()) {
    return chosen;
  }
  MatrixXd points(chosen.rows(), chosen.cols() + 1);
  points << posterior.fit->best, chosen;
  return points;
}

std::vector<Ridge> SimulatorSampler::findRidges(const PosteriorEstimate& posterior,
                                                const VectorXd& known) const {
  const MatrixXd places = listRidgePoints(posterior);
  if (places.cols() == 0 || !getSimulator().hasDerivatives()) {
    return {};
  }
  MatrixXd points(places.rows() + known.size(), places.cols());
  points << places, known.replicate(1, places.cols());
  return simulateRidges(getSimulator(), getExtractor(), getNoise(), getModelSpec(), points, 1);
}

}  // namespace twinmap
