#include "framework/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/log/notice.hpp"
#include "framework/base/log/search_stage.hpp"
#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/diagnosis/sharp_limit.hpp"
#include "framework/diagnosis/term_search.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/joint/joint_starts.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Without the searches and draws that only a posterior to be believed is worth.
ExplainedFit explain(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                     const MatrixXd& given, SimulatorPosteriorOptions options) {
  const RecordingsProblem problem(experiment, recordings);
  options.search.settles = true;
  options.spares_misfit = true;
  ExplainedFit fit{samplePosterior(problem.get(), given, options), {}};
  if (!(fit.posterior.degrees > 0.0)) {
    throw std::runtime_error(fit.posterior.message);
  }
  const VectorXd residual =
      recordings.hasFaults() ? problem.linearize(fit.posterior.best).residual : fit.posterior.residual;
  fit.test = testResidual(residual, fit.posterior.degrees, problem.listInfos());
  return fit;
}

/// The first p parameters of several posteriors with weights; nothing where one is not reliable.
AveragedEstimate mix(const std::vector<SimulatorPosterior>& posteriors, const std::vector<double>& weights,
                     Index p) {
  AveragedEstimate mixed;
  for (std::size_t i = 0; i < posteriors.size(); ++i) {
    if (!posteriors[i].isReliable()) {
      return {};
    }
    const Index before = mixed.weights.size(), count = posteriors[i].weights.size();
    mixed.draws.conservativeResize(p, before + count);
    mixed.draws.rightCols(count) = posteriors[i].draws.topRows(p);
    mixed.weights.conservativeResize(before + count);
    mixed.weights.tail(count) = weights[i] * posteriors[i].weights;
  }
  mixed.models = posteriors.size();
  mixed.weights /= mixed.weights.sum();
  mixed.mean = importance::calcMean({mixed.draws, mixed.weights});
  mixed.stddev = importance::calcCovariance({mixed.draws, mixed.weights}).diagonal().cwiseSqrt();
  return mixed;
}

/// From a fit that was found, which need not be confirmed where it explains little.
SimulatorPosteriorOptions searchFrom(bool confirms, const SimulatorPosteriorOptions& options) {
  SimulatorPosteriorOptions nearby = searchNearby(options);
  if (!confirms) {
    nearby.search.scouts = 0;
    nearby.search.max_batches = 0;
  }
  return nearby;
}

/// One diagnosis on its way.
class Diagnoser {
 public:
  Diagnoser(const DiagnosedRecordings& recordings, const DiagnosisOptions& options)
      : recordings_(recordings.features),
        coloured_(recordings.coloured),
        alone_(recordings.alone),
        options_(options) {}

  Diagnosis run(const ExperimentSpec& experiment) {
    Diagnosis diagnosis;
    diagnosis.level = options_.level;
    diagnosis.shared = experiment.model.parameters.size();
    {
      const SearchStage stage("fit the model as it is");
      diagnosis.before = explainAsItIs(experiment);
    }
    const SimulatorPosterior& before = diagnosis.before.posterior;
    shared_ = static_cast<Index>(experiment.model.parameters.size());
    requireCandidates(options_.candidates, experiment, recordings_, before.best);
    TermSearch search(recordings_, options_, {experiment, before.best, before.chi_square, before.degrees},
                      diagnosis.before.isExplained(), shared_);
    const std::size_t most =
        options_.accepted.empty() ? static_cast<std::size_t>(options_.max_terms) : options_.accepted.size();
    // each step adds a term or two, some drop one: twice as many end a search that would go round
    while (search.getFits().back().terms.size() < most && diagnosis.found < 2 * most) {
      const SearchStage stage(fmt::format("look for term {}", diagnosis.found + 1));
      diagnosis.steps.push_back(search.takeStep(diagnosis.found));
      if (!diagnosis.steps.back().found) {
        break;
      }
      ++diagnosis.found;
    }
    finish(search, diagnosis);
    return diagnosis;
  }

  /// From where the recordings alone fit best, as far as that is known.
  ExplainedFit explainAsItIs(const ExperimentSpec& experiment) const {
    const bool is_known = !alone_.empty() && std::all_of(alone_.begin(), alone_.end(), [](const auto& one) {
      return one.posterior.degrees > 0.0;
    });
    if (!is_known) {
      return explain(experiment, recordings_, {}, options_.posterior);
    }
    const MatrixXd starts = listJointStarts(RecordingsProblem(experiment, recordings_).get(), alone_,
                                            static_cast<Index>(experiment.model.parameters.size()));
    return explain(experiment, recordings_, starts, searchNearby(options_.posterior));
  }

 private:
  /// The shared parameters over what was found and all that the recordings do not tell from it; of a
  /// posterior that is not reliable nothing is said.
  void average(const TermSearch& search, Diagnosis& diagnosis) const {
    std::vector<SimulatorPosterior> posteriors{diagnosis.after.posterior};
    std::vector<double> evidence{1.0};
    SimulatorPosteriorOptions options = searchFrom(diagnosis.after.isExplained(), options_.posterior);
    options.spares_misfit = true;
    const std::vector<AlternativeFit> none;
    for (const AlternativeFit& other :
         diagnosis.found > 0 ? search.getAlternatives()[diagnosis.found - 1] : none) {
      if (!posteriors.back().isReliable()) {
        return;
      }
      const RecordingsProblem problem(other.experiment, recordings_);
      posteriors.push_back(samplePosterior(problem.get(), other.point, options));
      evidence.push_back(std::exp(other.log_evidence));
    }
    diagnosis.averaged = mix(posteriors, evidence, shared_);
  }

  /// Whether what was found stands out of what remains, both of a pair.
  static bool holdsCautiously(const DiagnosisStep& step) {
    return step.ranked.front().holds_cautiously && (!step.partner || step.partner->holds_cautiously);
  }

  /// Scales of what was found on toward their limits; those of laws that cannot be simulated so stay.
  CurrentFit followLimits(CurrentFit fit) const {
    for (const FoundTerm& term : fit.terms) {
      ExperimentSpec experiment = fit.experiment;
      RecordingFit followed{fit.point, fit.chi_square};
      try {
        followToLimit(recordings_, term.first, term.candidate, experiment, followed);
      } catch (const std::runtime_error&) {
        continue;
      }
      fit.experiment = std::move(experiment);
      fit.point = followed.point;
      fit.chi_square = followed.chi_square;
    }
    return fit;
  }

  /// Takes the last terms back that stand in for something else, then infers with those that are left.
  void finish(const TermSearch& search, Diagnosis& diagnosis) const {
    const std::vector<CurrentFit>& fits = search.getFits();
    const SearchStage stage("infer with what was found");
    diagnosis.after = diagnosis.before;
    CurrentFit last = fits.front();
    while (diagnosis.found > 0) {
      last = followLimits(fits[diagnosis.found]);
      diagnosis.after = explain(last.experiment, recordings_, last.point,
                                searchFrom(!isGross(last.chi_square, last.degrees), options_.posterior));
      DiagnosisStep& step = diagnosis.steps[diagnosis.found - 1];
      if (!options_.accepted.empty() || diagnosis.after.isExplained() || holdsCautiously(step)) {
        break;
      }
      step.found = false;
      diagnosis.steps.resize(diagnosis.found--);
      diagnosis.after = diagnosis.before;
      last = fits.front();
    }
    diagnosis.corrected = last.experiment;
    diagnosis.terms = last.terms;
    average(search, diagnosis);
    if (!diagnosis.after.isExplained() && diagnosis.found == 0) {
      countColours(diagnosis);
    }
    if (!diagnosis.after.isExplained()) {
      diagnosis.remainder =
          findRemainder(diagnosis.corrected, recordings_, diagnosis.after.posterior.best, shared_);
    }
    if (diagnosis.found > 0 && options_.accepted.empty()) {
      weighProcess(fits.front().experiment, diagnosis);
    }
  }

  /// Where no term is found, noise may be what it was found to be of each recording alone.
  void countColours(Diagnosis& diagnosis) const {
    if (!coloured_.hasFaults()) {
      return;
    }
    ExplainedFit fit = explain(diagnosis.corrected, coloured_, diagnosis.after.posterior.best,
                               searchNearby(options_.posterior));
    if (fit.isExplained() && fit.posterior.isReliable()) {
      diagnosis.after = std::move(fit);
      diagnosis.is_coloured = true;
      diagnosis.averaged = mix({diagnosis.after.posterior}, {1.0}, shared_);
    }
  }

  /// In the place of all terms.
  void weighProcess(const ExperimentSpec& without_terms, Diagnosis& diagnosis) const {
    // what they explain in the end, less what their freedom has cost each step: terms may have been exchanged
    double of_terms = 0.5 * (diagnosis.before.posterior.chi_square - diagnosis.after.posterior.chi_square);
    for (std::size_t i = 0; i < diagnosis.found; ++i) {
      const DiagnosisStep& step = diagnosis.steps[i];
      of_terms += step.log_evidence - 0.5 * (step.chi_square - step.ranked.front().chi_square);
    }
    std::optional<Remainder> process =
        findRemainder(without_terms, recordings_, diagnosis.before.posterior.best, shared_);
    if (process && process->log_evidence > of_terms - kTiedEvidence) {
      diagnosis.process_ties = process->log_evidence < of_terms + kTiedEvidence;
      diagnosis.process = std::move(process);
    }
  }

  const RecordedFeatures &recordings_, &coloured_;
  const std::vector<RecordingInference>& alone_;
  const DiagnosisOptions& options_;
  Index shared_ = 0;  // parameters of the machine, before any term
};

/// Gives `sized`, which was fitted, the unknown sizes of noise that the fit shows.
void sizeNoiseBy(const ExplainedFit& fit, const ExperimentSpec& stated, const RecordedFeatures& recordings,
                 ExperimentSpec& sized) {
  const std::vector<FeatureInfo> infos = RecordingsProblem(stated, recordings).listInfos();
  const std::vector<std::string> outputs = recordings.listOutputs(stated);
  const auto size = [&](const ExperimentSpec& from, const std::vector<std::string>& names,
                        ExperimentSpec& to) {
    to.noise = sizeNoise(from.noise, {to.noise, fit.posterior.residual, fit.posterior.degrees, infos}, names);
  };
  for (std::size_t t = 0; t < sized.trials.size(); ++t) {
    const std::string prefix = nameInTrial(sized.trials[t].name, "");
    std::vector<std::string> own;
    for (const std::string& output : outputs) {
      own.push_back(output.rfind(prefix, 0) == 0 ? output.substr(prefix.size()) : "");
    }
    size(stated.trials[t].experiment, own, sized.trials[t].experiment);
  }
  size(stated, outputs, sized);
}

/// With the noise that is left by what was found: as long as more is found.
void diagnoseAgain(const ExperimentSpec& experiment, const RecordedFeatures& recordings, Diagnoser& diagnoser,
                   ExperimentSpec& sized, Diagnosis& diagnosis) {
  for (int round = 0; round < kFewIterations && diagnosis.found > 0; ++round) {
    const std::vector<std::string> before = diagnosis.listTerms();
    sizeNoiseBy(diagnosis.after, experiment, recordings, sized);
    diagnosis = diagnoser.run(sized);
    if (diagnosis.listTerms() == before) {
      return;
    }
  }
}

}  // namespace

MatrixXd AveragedEstimate::calcQuantiles(const VectorXd& probabilities) const {
  return importance::calcQuantiles({draws, weights}, probabilities);
}

std::vector<std::string> Diagnosis::listAtBounds() const {
  std::vector<std::string> names;
  const VectorXd& best = before.posterior.best;
  for (std::size_t i = 0; i < shared && best.size() > 0 && !before.isExplained(); ++i) {
    const ParameterSpec& parameter = corrected.model.parameters[i];
    const double lower = parameter.bounds.lower, upper = parameter.bounds.upper;
    if (std::abs(2.0 * best[static_cast<Index>(i)] - lower - upper) > kAtBound * (upper - lower)) {
      names.push_back(parameter.name.text);
    }
  }
  return names;
}

std::vector<std::string> Diagnosis::listTermsAtBounds() const {
  const std::vector<ParameterSpec>& parameters = corrected.model.parameters;
  std::vector<std::string> names;
  for (const Index j : after.posterior.beyond) {
    const auto number = static_cast<std::size_t>(j);
    if (found > 0 && number >= shared && number < parameters.size()) {
      names.push_back(parameters[number].name.text);
    }
  }
  return names;
}

const char* Diagnosis::getStatus() const {
  if (isIncomplete()) {
    return getNotice(Notice::kModelIncomplete).name;
  }
  if (is_coloured) {
    return getNotice(Notice::kNoiseColoured).name;
  }
  return getNotice(found > 0 && !after.posterior.isReliable() ? Notice::kUnreliable : Notice::kOk).name;
}

std::vector<std::string> Diagnosis::listTerms() const {
  std::vector<std::string> names;
  for (const FoundTerm& term : terms) {
    names.push_back(term.candidate.term);
  }
  return names;
}

std::vector<std::string> Diagnosis::listFaults() const {
  std::vector<std::string> faults = listRecordingFaults(alone);
  const auto is_tested = [&](const std::string& fault) {
    return twinmap::getStatus(fault).concern == Concern::kNuisance ||
           (fault == getNotice(Notice::kSensorOffset).name && alone.size() == 1) ||
           (fault == getNotice(Notice::kNoiseColoured).name && !is_coloured);
  };
  faults.erase(std::remove_if(faults.begin(), faults.end(), is_tested), faults.end());
  return faults;
}

Diagnosis diagnose(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const DiagnosisOptions& options) {
  return diagnoseExplained(experiment, {recordings, recordings, {}}, options);
}

Diagnosis diagnoseExplained(const ExperimentSpec& experiment, const DiagnosedRecordings& recordings,
                            const DiagnosisOptions& options) {
  requireSystem(experiment);
  ExperimentSpec sized = experiment;
  Diagnoser diagnoser(recordings, options);
  if (hasUnknownNoise(experiment.noise)) {
    const SearchStage stage("find the size of the noise");
    sizeNoiseBy(diagnoser.explainAsItIs(experiment), experiment, recordings.features, sized);
  }
  Diagnosis diagnosis = diagnoser.run(sized);
  if (hasUnknownNoise(experiment.noise)) {
    diagnoseAgain(experiment, recordings.features, diagnoser, sized, diagnosis);
  }
  diagnosis.noise = sized.noise;
  copyNoise(experiment, diagnosis.corrected);
  diagnosis.alone = recordings.alone;
  return diagnosis;
}

}  // namespace twinmap
