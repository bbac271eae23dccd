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
#include "framework/study/pipeline/shared_error.hpp"
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
      (mayBeElsewhere(tests.inferred[i]) ? tests.elsewhere : tests.near).all.push_back(i);
    }
  }
}

void chooseEvenly(std::size_t count, NeedingTests& tests) {
  count = std::min(count, tests.all.size());
  for (std::size_t k = 0; k < count; ++k) {
    tests.sampled.push_back(tests.all[(2 * k + 1) * tests.all.size() / (2 * count)]);
  }
}

/// Refined estimates stand for those that are near: what is sampled corrects them only.
void chooseSampled(InferredTests& tests) {
  constexpr double kSureElsewhere = 304.0;  // .95 * .05 / .0125^2: coverage to 1.25 %
  constexpr double kSureNear = 119.0;       // to 2 %
  constexpr std::size_t kMinNear = 3;       // for the standard error of a correction
  const std::size_t n = tests.inferred.size();
  chooseEvenly(countSampled(tests.elsewhere.all.size(), n, kSureElsewhere), tests.elsewhere);
  chooseEvenly(std::max(kMinNear, countSampled(tests.near.all.size(), n, kSureNear)), tests.near);
}

void sampleAll(const Study& study, const LabelledFeatures& test, const TrustModel* trust,
               InferredTests& tests) {
  const SimulatorPosteriorOptions options =
      makePosteriorOptions(study.experiment, SimulatorPosteriorOptions{}.draws);
  const std::vector<std::size_t> sampled = tests.listSampled();
  runOnTeam(study.simulator, static_cast<int>(sampled.size()), study.control.threads,
            [&](Simulator& simulator, int i) {
              throwIfCancelled(study.control, "interrupted while posteriors were sampled");
              const SimulatorRefiner refiner(study.experiment, simulator.getLayout(), simulator.clone());
              const std::size_t sample = sampled[static_cast<std::size_t>(i)];
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
  chooseSampled(tests);
  const std::size_t count = tests.listSampled().size();
  if (count == 0) {
    return;
  }
  logInfo(fmt::format("posteriors are needed of {} of {} test samples", tests.countNeeding(),
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

std::vector<std::size_t> InferredTests::listSampled() const {
  std::vector<std::size_t> sampled = elsewhere.sampled;
  sampled.insert(sampled.end(), near.sampled.begin(), near.sampled.end());
  return sampled;
}

std::size_t countSampled(std::size_t needing, std::size_t all, double as_sure_as) {
  const auto a = static_cast<double>(all), m = static_cast<double>(needing);
  // with m^2 / count + (a - m) for the sum of the squared weights, whose inverse is to be as_sure_as / a^2
  const double room = a * a / as_sure_as - (a - m);
  return room > 0.0 ? std::min(needing, static_cast<std::size_t>(std::ceil(m * m / room))) : needing;
}

InferredTests inferTestSamples(const Study& study, const PreparedData& data, TrainedMap& map) {
  InferredTests tests;
  const LabelledFeatures& test = data.labelled.test;
  const std::vector<ParameterSpec>& parameters = study.experiment.model.parameters;
  TrustModel* trust = map.online.trust ? &*map.online.trust : nullptr;
  const bool refines = shouldRefine(study.experiment.refine, study.simulator, study.noise);
  tests.by_estimator = timeStage("infer the test samples", tests.notes, [&] {
    map.online.shared_error = calcSharedError(study, data, map);
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
