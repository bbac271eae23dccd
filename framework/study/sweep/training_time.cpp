#include "framework/study/sweep/training_time.hpp"

#include <algorithm>
#include <cmath>

#include "framework/study/sweep/case_cost.hpp"

namespace twinmap {
namespace {

/// A power law through two measurements; the exponent lies between those of O(1) and O(n^3).
double interpolate(const EvaluationTime& a, const EvaluationTime& b, double samples) {
  const double exponent =
      std::clamp(std::log(b.seconds / a.seconds) / std::log(b.samples / a.samples), 0.0, 3.0);
  return a.seconds * std::pow(samples / a.samples, exponent);
}

}  // namespace

double TrainingTime::calcEvaluation(double samples) const {
  const EvaluationTime &first = measured.front(), &last = measured.back();
  if (samples <= first.samples) {
    return first.seconds * samples / first.samples;
  }
  if (samples >= last.samples) {
    return last.seconds * std::pow(samples / last.samples, 3.0);
  }
  const auto above = std::find_if(measured.begin(), measured.end(),
                                  [&](const EvaluationTime& time) { return time.samples >= samples; });
  return interpolate(*(above - 1), *above, samples);
}

double TrainingTime::calcTraining(const ExperimentSpec& experiment) const {
  if (experiment.inverse_map.isNone()) {
    return 0.0;
  }
  if (experiment.inverse_map.findNetwork() != nullptr) {
    return measured.back().seconds;  // steps and batches do not grow with the samples
  }
  if (experiment.inverse_map.findGp() == nullptr) {
    return calcEvaluation(experiment.design.train.samples);
  }
  double seconds = 0.0, of_search = evaluations;
  for (const TrainingStep& step : listTrainingSteps(experiment)) {
    const double count = step.searches > 0.0 ? step.searches * of_search : 1.0;
    seconds += step.processes * count * step.relative_cost * calcEvaluation(step.samples);
    of_search = evaluations_all;
  }
  return seconds;
}

}  // namespace twinmap
