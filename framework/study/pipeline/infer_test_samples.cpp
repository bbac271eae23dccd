#include "framework/study/pipeline/infer_test_samples.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "framework/base/log/log.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/estimation/refined/refine.hpp"
#include "framework/estimation/trained/refinement_starts.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/measurement/posterior_need.hpp"
#include "framework/inference/refiner.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/study/pipeline/evaluate_estimates.hpp"
#include "framework/study/pipeline/training/store_map.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd getKnown(const LabelledFeatures& test, Index i) {
  return test.inputs.rows() > 0 ? VectorXd(test.inputs.col(i)) : VectorXd();
}

/// "121 accepted, 3 accepted from surrogate, 5 nonlinear"
std::string describe(const std::vector<Refined>& refined) {
  std::map<std::string, int> counts;
  for (const Refined& one : refined) {
    const std::string start = one.start == "inverse_map" ? "" : " from " + one.start;
    ++counts[one.isAccepted() ? "accepted" + start : toString(one.status)];
  }
  std::string text;
  for (const auto& [name, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  }
  return text;
}

/// A warning where a user would not get a refined estimate of one measurement in ten or more.
void warnOfFew(const std::vector<Refined>& refined, const std::string& outcome, StageNotes& notes) {
  constexpr double kMin = 0.9;
  const std::size_t accepted = findAccepted(refined).size();
  if (static_cast<double>(accepted) < kMin * static_cast<double>(refined.size())) {
    notes.warn(makeWarning(Notice::kFewRefined, accepted, refined.size(), outcome));
  }
}

std::vector<InferredMeasurement> inferAll(const OnlineModel& online, const LabelledFeatures& test) {
  OnlineWorkspace workspace(online);
  std::vector<InferredMeasurement> inferred;
  for (Index i = 0; i < test.features.cols(); ++i) {
    inferred.push_back(inferOnline(online, test.features.col(i), getKnown(test, i), workspace));
  }
  return inferred;
}

std::vector<Refined> refineAll(const Study& study, const LabelledFeatures& test, const TrustModel* trust,
                               const std::vector<InferredMeasurement>& inferred) {
  const RefinementModel model(collectUnknown(study.experiment.model), study.extractor, study.noise);
  std::vector<RefinementTask> tasks;
  for (std::size_t i = 0; i < inferred.size(); ++i) {
    const auto column = static_cast<Index>(i);
    tasks.push_back(makeTask(study.experiment.model, trust, inferred[i], test.features.col(column),
                             getKnown(test, column)));
  }
  std::vector<Refined> refined =
      refineOrAbortEarly(study.simulator, model, std::move(tasks), study.control.threads, [&] {
        throwIfCancelled(study.control, "interrupted during refinement; the simulated samples are kept");
      });
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (isMultimodal(inferred[i].by_estimator.mixture)) {
      rejectAsMultimodal(refined[i]);
    }
  }
  return refined;
}

void findNeeding(const Study& study, InferredTests& tests) {
  const std::vector<FeatureInfo>& infos = study.extractor.getInfos();
  for (std::size_t i = 0; i < tests.inferred.size(); ++i) {
    if (needsPosterior(tests.inferred[i], study.experiment.model.parameters, infos)) {
      tests.needing.push_back(i);
      tests.near.push_back(!mayBeWrong(tests.inferred[i], infos));
    }
  }
}

std::vector<std::size_t> chooseEvenly(const std::vector<std::size_t>& from, std::size_t count) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    chosen.push_back(from[(2 * k + 1) * from.size() / (2 * count)]);
  }
  return chosen;
}

void sampleAll(const Study& study, const LabelledFeatures& test, const TrustModel* trust,
               InferredTests& tests) {
  const SimulatorPosteriorOptions options =
      makePosteriorOptions(study.experiment, SimulatorPosteriorOptions{}.draws);
  runOnTeam(study.simulator, static_cast<int>(tests.sampled.size()), study.control.threads,
            [&](Simulator& simulator, int i) {
              throwIfCancelled(study.control, "interrupted while posteriors were sampled");
              const SimulatorRefiner refiner(study.experiment, simulator.getLayout(), simulator.clone());
              const std::size_t sample = tests.sampled[static_cast<std::size_t>(i)];
              const auto column = static_cast<Index>(sample);
              refiner.sampleAndJudge(test.features.col(column), getKnown(test, column), trust, options,
                                     tests.inferred[sample]);
            });
}

/// Those for which least squares may mislead.
void sampleNeeding(const Study& study, const LabelledFeatures& test, const TrustModel* trust,
                   InferredTests& tests) {
  if (!shouldRefine(RefineMode::kAutomatic, study.simulator, study.noise)) {
    return;  // as MeasurementSession
  }
  findNeeding(study, tests);
  const std::size_t count = countSampled(tests.needing.size(), tests.inferred.size());
  if (count == 0) {
    return;
  }
  tests.sampled = chooseEvenly(tests.needing, count);
  logInfo(fmt::format("posteriors are needed of {} of {} test samples", tests.needing.size(),
                      tests.inferred.size()));
  timeStage(fmt::format("sample {} of them on the simulator", count), tests.notes, [&] {
    sampleAll(study, test, trust, tests);
    return count;
  });
}

/// The map's estimates, of which those of a surrogate are known already.
Estimates predict(const LabelledFeatures& test, const TrainedMap& map,
                  const std::vector<InferredMeasurement>& inferred) {
  if (inferred.empty() || map.online.map->findForward() == nullptr) {
    return map.predict(test.features, test.inputs);
  }
  const Index p = test.parameters.rows(), n = test.parameters.cols();
  Estimates estimates{Eigen::MatrixXd(p, n), Eigen::MatrixXd(p, n)};
  estimates.limit_stddev.resize(p, n);
  for (Index i = 0; i < n; ++i) {
    const Estimate& one = inferred[static_cast<std::size_t>(i)].by_estimator;
    estimates.mean.col(i) = one.mean;
    estimates.stddev.col(i) = one.stddev;
    estimates.limit_stddev.col(i) = one.limit_stddev;
  }
  return estimates;
}

void refineTests(const Study& study, const LabelledFeatures& test, const TrustModel* trust,
                 InferredTests& tests) {
  try {
    tests.refined = timeStage("refine the test samples", tests.notes,
                              [&] { return refineAll(study, test, trust, tests.inferred); });
    const std::string outcome = describe(tests.refined);
    logInfo(fmt::format("refined: {}", outcome));
    warnOfFew(tests.refined, outcome, tests.notes);
  } catch (const std::invalid_argument& error) {
    tests.inferred.clear();
    tests.notes.warn(makeWarning(Notice::kCannotRefine, error.what()));
  }
}

}  // namespace

std::size_t countSampled(std::size_t needing, std::size_t all) {
  constexpr double kAsSureAs = 119.0;  // .95 * .05 / .02^2
  constexpr std::size_t kMin = 3;
  const auto a = static_cast<double>(all), m = static_cast<double>(needing);
  // with m^2 / count + (a - m) for the sum of the squared weights, whose inverse is to be kAsSureAs / a^2
  const double room = a * a / kAsSureAs - (a - m);
  const double count = room > 0.0 ? std::ceil(m * m / room) : m;
  return std::min(needing, std::max(kMin, static_cast<std::size_t>(count)));
}

InferredTests inferTestSamples(const Study& study, const PreparedData& data, TrainedMap& map) {
  InferredTests tests;
  const LabelledFeatures& test = data.labelled.test;
  const std::vector<ParameterSpec>& parameters = study.experiment.model.parameters;
  TrustModel* trust = map.online.trust ? &*map.online.trust : nullptr;
  const bool refines = shouldRefine(study.experiment.refine, study.simulator, study.noise);
  tests.by_estimator = timeStage("infer the test samples", tests.notes, [&] {
    tests.inferred = refines ? inferAll(map.online, test) : std::vector<InferredMeasurement>();
    return predict(test, map, tests.inferred);
  });
  if (trust != nullptr) {
    trust->coverage =
        recordCoverage(summarizeMap(map.name, parameters, test.parameters, tests.by_estimator, {}));
  }
  if (refines) {
    refineTests(study, test, trust, tests);
  }
  if (tests.inferred.empty()) {
    return tests;
  }
  if (trust != nullptr) {
    trust->refinement = collectReference(tests.refined);
    trust->refined_coverage =
        recordCoverage(summarizeRefined(parameters, test.parameters, tests.refined, {}));
  }
  for (std::size_t i = 0; i < tests.inferred.size(); ++i) {
    tests.inferred[i].estimator_is_calibrated = isCalibrated(*map.online.map, trust);
    tests.inferred[i].estimator_coverage_is_short = trust != nullptr && trust->coverage.isShort();
    takeRefined(tests.refined[i], trust, tests.inferred[i]);
  }
  sampleNeeding(study, test, trust, tests);
  return tests;
}

}  // namespace twinmap
