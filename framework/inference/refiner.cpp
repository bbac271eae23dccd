#include "framework/inference/refiner.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "framework/base/text/source_location.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/estimation/posterior/noise/noise_candidates.hpp"
#include "framework/estimation/ridges/simulated_ridges.hpp"
#include "framework/estimation/trained/refinement_starts.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/experiment/points/prior.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Draws that stand for the posterior, each once at most: where the sum of the weights passes equal steps.
std::vector<Index> chooseDraws(const VectorXd& weights) {
  constexpr double kDraws = 32.0;
  std::vector<Index> chosen;
  double passed = 0.0;
  for (Index i = 0; i < weights.size(); ++i) {
    const double before = passed;
    passed += weights[i];
    if (std::floor(passed * kDraws + 0.5) > std::floor(before * kDraws + 0.5)) {
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

ResponseNoise makeNoise(const NoiseSpec& spec, const ResponseLayout& layout, const VectorXd& stddev) {
  ResponseNoise noise(spec, layout);
  noise.replace(stddev);
  return noise;
}

NoiseHypothesis findUnknownNoise(const NoiseSpec& noise, const ResponseLayout& layout) {
  NoiseHypothesis hypothesis;
  for (const OutputNoiseSpec& spec : noise.stddev) {
    const auto& names = layout.output_names;
    const auto found = std::find(names.begin(), names.end(), spec.name.text);
    if (spec.stddev.unknown && found != names.end()) {
      hypothesis.outputs.push_back({static_cast<int>(found - names.begin()), std::nullopt});
    }
  }
  return hypothesis;
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

SimulatorRefiner::SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout,
                                   Model model, const StatedNoise& stated)
    : SimulatorRefiner(experiment, layout,
                       model == Model::kTrusted
                           ? makeTrustedSimulator(experiment.model, layout.times, layout.modes)
                           : makeSimulator(experiment.model, layout.times, layout.modes),
                       stated) {}

SimulatorRefiner::SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout,
                                   std::unique_ptr<Simulator> simulator, const StatedNoise& stated)
    : model_(experiment.model),
      output_noise_(experiment.noise.stddev),
      noise_scale_(experiment.noise.scale),
      extractor_(makeExtractor(experiment, layout)),
      simulator_(std::move(simulator)),
      noise_(extractor_, makeNoise(experiment.noise, layout, stated.rows), experiment.seed, stated.features),
      stated_noise_(findUnknownNoise(experiment.noise, layout)),
      wanted_(shouldRefine(experiment.refine, *simulator_, noise_)),
      own_(simulator_->clone()) {}

const RefinementModel& SimulatorRefiner::getModel() const {
  if (!shared_) {
    shared_.emplace(collectUnknown(model_), extractor_, noise_);
  }
  return *shared_;
}

RefinementTask SimulatorRefiner::makeTask(const InferredMeasurement& inferred, const VectorXd& features,
                                          const VectorXd& known, const TrustModel* trust) const {
  return makeRefinementTask(
      model_, trust, features,
      {inferred.by_estimator.takeLikeliest().mean, inferred.explanation, known, inferred.covariance});
}

Refined SimulatorRefiner::refine(const InferredMeasurement& inferred, const VectorXd& features,
                                 const VectorXd& known, const TrustModel* trust) const {
  Refined refined = twinmap::refine(*own_, getModel(), makeTask(inferred, features, known, trust));
  if (isMultimodal(inferred.by_estimator.mixture)) {
    rejectAsMultimodal(refined);
  }
  if (refined.isAccepted()) {
    const Index p = inferred.by_estimator.mean.size();
    refined.mean.conservativeResize(p);
    refined.stddev.conservativeResize(p);
    refined.covariance.conservativeResize(p, p);
  }
  return refined;
}

void SimulatorRefiner::refineAndJudge(const VectorXd& features, const VectorXd& known,
                                      const TrustModel* trust, InferredMeasurement& inferred) const {
  inferred.refined = refine(inferred, features, known, trust);
  const Refined& refined = *inferred.refined;
  if (trust != nullptr) {
    SimulatorResidual found{
        refined.residual, refined.calcReducedChiSquare(), refined.degrees, refined.explained, {}, {}};
    if (refined.isAccepted()) {
      inferred.coverage_is_short = trust->refined_coverage.isShort();
      found.mean = refined.mean;
      found.stddev = refined.stddev;
    }
    inferred.trust = judgeAnew(*trust, *inferred.trust, found);
  }
}

void SimulatorRefiner::requireNoise() const {
  try {
    getModel();
  } catch (const std::invalid_argument& error) {
    throw ExperimentError(
        std::string(error.what()) +
        ": a measurement says nothing about parameters unless its noise is known; give every output that "
        "features read a 'noise.stddev'");
  }
}

bool SimulatorRefiner::samplesFast() const {
  return shouldRefine(RefineMode::kAutomatic, *simulator_, noise_);
}

PosteriorEstimate SimulatorRefiner::sampleUnder(const NoiseHypothesis& noise, const VectorXd& features,
                                                const VectorXd& known, const MatrixXd& given,
                                                const SimulatorPosteriorOptions& options) const {
  const auto u = static_cast<Index>(getUnknown().size());
  PosteriorProblem problem{getUnknown(), model_.priors, {makeTrial(features, known)}, u};
  problem.trials.front().noise = noise;
  return makeEstimate(problem.trials.front(), twinmap::samplePosterior(problem, given, options));
}

PosteriorEstimate SimulatorRefiner::samplePosterior(const VectorXd& features, const VectorXd& known,
                                                    const NoiseHypothesis& stated, const MatrixXd& given,
                                                    const SimulatorPosteriorOptions& options) const {
  const bool is_known = stated.outputs.empty();
  PosteriorEstimate sampled =
      sampleUnder(is_known ? stated : guessSizes(stated, *makeTrial(features, known).model, features),
                  features, known, given, options);
  if (!is_known && sampled.fit->isSimulated()) {
    sampled = sampleUnder(stated, features, known, sampled.fit->best, options);
  }
  if (!sampled.fit->isSimulated() || sampled.fit->isPlausible()) {
    return sampled;
  }
  if (!readsOutputs()) {
    return sampled;
  }
  for (const NoiseHypothesis& noise : listNoise(stated, features, known, sampled.fit->best)) {
    PosteriorEstimate other = sampleUnder(noise, features, known, sampled.fit->best, options);
    if (other.isReliable() && explains(*other.fit, sampled.fit->residual.size())) {
      return other;
    }
  }
  return sampled;
}

std::string SimulatorRefiner::findFailure(const VectorXd& known) const {
  constexpr Index kPoints = 4;  // the centre of the bounds first
  const std::vector<ParameterSpec>& unknown = getUnknown();
  PointSetSpec sobol;
  sobol.method = DesignMethod::kSobol;
  sobol.samples = kPoints - 1;
  const auto u = static_cast<Index>(unknown.size());
  MatrixXd points(u + known.size(), kPoints);
  const MatrixXd unit = sampleUnitCube(sobol, static_cast<int>(u), 1, RandomPurpose::kBasinStarts);
  const VectorXd center = calcBoxCenter(unknown), widths = calcWidths(unknown);
  points.topRows(u).col(0) = center;
  for (Index i = 1; i < kPoints; ++i) {
    points.col(i).head(u) = center.array() + widths.array() * (unit.col(i - 1).array() - 0.5);
  }
  points.bottomRows(known.size()).colwise() = known;
  MatrixXd responses(simulator_->getLayout().getRowCount(), kPoints);
  std::vector<SampleStatus> statuses(kPoints);
  own_->simulate(points.leftCols(1), responses.leftCols(1), statuses.data());
  if (!statuses.front().ok) {
    own_->simulate(points.rightCols(kPoints - 1), responses.rightCols(kPoints - 1), statuses.data() + 1);
  }
  const bool fails =
      std::none_of(statuses.begin(), statuses.end(), [](const SampleStatus& one) { return one.ok; });
  return fails ? statuses.front().reason : "";
}

PosteriorEstimate SimulatorRefiner::makeFailed(const VectorXd& features, const VectorXd& known,
                                               const std::string& reason) const {
  SimulatorPosterior posterior;
  posterior.message = reason;
  return makeEstimate(makeTrial(features, known), std::move(posterior));
}

double SimulatorRefiner::findLeastChiSquare(const VectorXd& features, const VectorXd& known,
                                            Index all) const {
  const auto there = static_cast<double>(features.array().isFinite().count()), of = static_cast<double>(all);
  if (2.0 * there <= of) {
    return std::numeric_limits<double>::infinity();
  }
  return of / there *
         twinmap::findLeastChiSquare({getUnknown(),
                                      model_.priors,
                                      {makeTrial(features, known)},
                                      static_cast<Index>(getUnknown().size())});
}

PosteriorEstimate SimulatorRefiner::makeEstimate(const MeasuredTrial& trial,
                                                 SimulatorPosterior posterior) const {
  std::vector<FeatureInfo> infos = extractor_.getInfos();
  if (trial.own_model) {
    infos.clear();
    for (const Index i : trial.own_model->getWhole().features) {
      infos.push_back(trial.own_model->getExtractor().getInfos()[static_cast<std::size_t>(i)]);
    }
  } else if (posterior.degrees > 0.0) {
    posterior.standardized.residual = getModel().placeResidual(posterior.standardized.residual);
  }
  PosteriorEstimate made =
      makePosteriorEstimate(posterior, getUnknown(), static_cast<Index>(model_.parameters.size()), infos);
  nameNoise(*made.fit);
  return made;
}

bool SimulatorRefiner::readsOutputs() const {
  const std::vector<OutputSpec>& outputs = model_.outputs;
  const std::vector<std::string>& read = simulator_->getLayout().output_names;
  return std::all_of(read.begin(), read.end(), [&](const std::string& name) {
    return std::any_of(outputs.begin(), outputs.end(),
                       [&](const OutputSpec& output) { return output.name.text == name; });
  });
}

void SimulatorRefiner::nameNoise(SimulatorFit& fit) const {
  const ResponseLayout& layout = simulator_->getLayout();
  for (NoiseReport& report : fit.noise) {
    const auto output = static_cast<std::size_t>(report.found.output);
    report.output = layout.output_names[output];
    report.unit = layout.output_units[output];
    const auto stated =
        std::find_if(output_noise_.begin(), output_noise_.end(),
                     [&](const OutputNoiseSpec& spec) { return spec.name.text == report.output; });
    const double stddev = noise_scale_ * stated->stddev;
    report.stated = stated->stddev.unknown ? 0.0 : stddev;
    report.stddev = report.found.factor * stddev;
  }
}

NoiseHypothesis SimulatorRefiner::describeNoise(const std::vector<ClippedSample>& clipped) const {
  NoiseHypothesis noise = stated_noise_;
  for (const ClippedSample& sample : clipped) {
    noise.censored.push_back({sample.row, sample.side});
  }
  std::sort(noise.censored.begin(), noise.censored.end(),
            [](const CensoredFeature& a, const CensoredFeature& b) { return a.feature < b.feature; });
  return noise;
}

std::vector<NoiseHypothesis> SimulatorRefiner::listNoise(const NoiseHypothesis& stated,
                                                         const VectorXd& features, const VectorXd& known,
                                                         const VectorXd& best) const {
  const MeasuredTrial trial = makeTrial(features, known);
  const SearchBox box(getUnknown(), {0, static_cast<Index>(getUnknown().size())}, trial.held);
  Misfit misfit(*own_, *trial.model, box, features);
  VectorXd point = trial.held;
  point.head(best.size()) = best;
  const LocalMisfit local = misfit.linearize(box.normalize(point));
  if (!local.status.ok) {
    return {};
  }
  return listNoiseHypotheses(stated, {trial.model, local.residual, local.jacobian});
}

MatrixXd SimulatorRefiner::listRidgePoints(const PosteriorEstimate& posterior) const {
  const BoundedDraws& draws = posterior.estimate.draws;
  if (!draws.isGiven()) {
    return posterior.places;
  }
  const bool may_have =
      !Prior(getUnknown(), model_.priors).isUniform() || mayHaveRidges(draws, model_.parameters);
  return may_have ? MatrixXd(draws.points(Eigen::all, chooseDraws(draws.weights))) : MatrixXd();
}

std::vector<Ridge> SimulatorRefiner::findRidges(const PosteriorEstimate& posterior,
                                                const VectorXd& known) const {
  const MatrixXd places = listRidgePoints(posterior);
  if (places.cols() == 0 || !simulator_->hasDerivatives()) {
    return {};
  }
  MatrixXd points(places.rows() + known.size(), places.cols());
  points << places, known.replicate(1, places.cols());
  return simulateRidges(*simulator_, extractor_, noise_, model_, points, 1);
}

MeasuredTrial SimulatorRefiner::makeTrial(const VectorXd& features, const VectorXd& known) const {
  const std::vector<ParameterSpec>& unknown = getUnknown();
  VectorXd held(static_cast<Index>(unknown.size()) + known.size());
  held << calcBoxCenter(unknown), known;
  std::vector<Index> all(unknown.size());
  std::iota(all.begin(), all.end(), Index{0});
  MeasuredTrial trial{own_.get(), &getModel(), features, held, std::move(all)};
  trial.noise = stated_noise_;
  if (features.hasNaN()) {
    const VectorXd fitted = getModel().convert(features);
    std::vector<Index> available;
    for (Index i = 0; i < fitted.size(); ++i) {
      if (std::isfinite(fitted[i])) {
        available.push_back(i);
      }
    }
    trial.own_model =
        std::make_shared<const RefinementModel>(unknown, extractor_, noise_, std::move(available));
    trial.model = trial.own_model.get();
  }
  return trial;
}

MatrixXd SimulatorRefiner::listStarts(const InferredMeasurement& inferred, const VectorXd& features,
                                      const VectorXd& known, const TrustModel* trust) const {
  std::vector<VectorXd> points;
  for (Index k = 0; k < inferred.basins.cols(); ++k) {
    points.emplace_back(inferred.basins.col(k));
  }
  for (const RefinementStart& start : makeTask(inferred, features, known, trust).starts) {
    points.push_back(start.point);
  }
  for (Index c = 0; c < inferred.by_estimator.mixture.countComponents(); ++c) {
    points.push_back(
        makePoint(model_, inferred.by_estimator.mixture.means.col(c), inferred.explanation, known));
  }
  if (inferred.refined) {
    points.push_back(inferred.refined->point);
  }
  const auto u = static_cast<Index>(getModel().getUnknown().size());
  MatrixXd starts(u, static_cast<Index>(points.size()));
  for (Index k = 0; k < starts.cols(); ++k) {
    starts.col(k) = points[static_cast<std::size_t>(k)].head(u);
  }
  return starts;
}

void SimulatorRefiner::sampleAndJudge(const VectorXd& features, const VectorXd& known,
                                      const TrustModel* trust, const SimulatorPosteriorOptions& options,
                                      InferredMeasurement& inferred) const {
  inferred.posterior = samplePosterior(features, known, describeNoise({}),
                                       listStarts(inferred, features, known, trust), options);
  const SimulatorFit& fit = *inferred.posterior->fit;
  if (trust != nullptr && !fit.isAsStated()) {
    inferred.trust.reset();
  } else if (trust != nullptr && fit.isSimulated()) {
    const Estimate& estimate = inferred.posterior->estimate;
    inferred.trust = judgeAnew(*trust, *inferred.trust,
                               {fit.residual, fit.chi_square / fit.degrees, fit.degrees, fit.explained,
                                estimate.mean, estimate.stddev});
  }
}

Refined SimulatorRefiner::fitNuisance(const VectorXd& point, const VectorXd& features) const {
  const SearchedParameters nuisance{static_cast<Index>(model_.parameters.size()),
                                    static_cast<Index>(model_.nuisance.size())};
  if (nuisance.count == 0) {
    Refined held;
    held.status = RefinementStatus::kAccepted;
    held.point = point;
    return held;
  }
  return twinmap::refine(*own_, getModel(),
                         {features, {{"given", point}}, nuisance, false, {}, findPrior(model_)});
}

}  // namespace twinmap
