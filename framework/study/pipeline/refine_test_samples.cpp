#include "framework/study/pipeline/refine_test_samples.hpp"

#include <fmt/core.h>

#include <map>
#include <stdexcept>

#include "framework/base/log/log.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/estimation/refined/refine.hpp"
#include "framework/estimation/trained/refinement_starts.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/study/pipeline/evaluate_estimates.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

Eigen::VectorXd getKnown(const LabelledFeatures& test, Index i) {
  return test.inputs.rows() > 0 ? Eigen::VectorXd(test.inputs.col(i)) : Eigen::VectorXd();
}

struct RefinementTasks {
  std::vector<RefinementTask> tasks;
  std::vector<bool> multimodal;  ///< whether the map's estimate is
};

/// From what the online map and its trust model say.
RefinementTasks makeTasks(const Study& study, const PreparedData& data, const OnlineModel& online) {
  const LabelledFeatures& test = data.labelled.test;
  const std::unique_ptr<Estimator::Workspace> inferring = online.map->makeWorkspace();
  const TrustModel* trust = online.trust ? &*online.trust : nullptr;
  std::optional<TrustWorkspace> judging;
  if (trust != nullptr) {
    judging.emplace(*trust);
  }
  RefinementTasks all;
  for (Index i = 0; i < test.features.cols(); ++i) {
    InitialEstimate initial;
    initial.known = getKnown(test, i);
    const Estimate& estimate = online.map->infer(test.features.col(i), initial.known, *inferring);
    initial.mean = estimate.takeLikeliest().mean;
    if (trust != nullptr) {
      judge(*trust, test.features.col(i), initial.known, estimate, inferring->findExplanation(), *judging);
      initial.explanation = trust->makeSampledPoint(judging->explanation->point);
      initial.covariance = judging->explanation->calcCovariance();
    }
    all.tasks.push_back(makeRefinementTask(study.experiment.model, trust, test.features.col(i), initial));
    all.multimodal.push_back(isMultimodal(estimate.mixture));
  }
  return all;
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

std::vector<Refined> refineAll(const Study& study, const PreparedData& data, const OnlineModel& online) {
  const RefinementModel model(collectUnknown(study.experiment.model), study.extractor, study.noise);
  RefinementTasks all = makeTasks(study, data, online);
  std::vector<Refined> refined =
      refineOrAbortEarly(study.simulator, model, std::move(all.tasks), study.control.threads, [&] {
        throwIfCancelled(study.control, "interrupted during refinement; the simulated samples are kept");
      });
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (all.multimodal[i]) {
      rejectAsMultimodal(refined[i]);
    }
  }
  return refined;
}

}  // namespace

RefinedTests refineTestSamples(const Study& study, const PreparedData& data, const OnlineModel& online) {
  RefinedTests tests;
  if (!shouldRefine(study.experiment.refine, study.simulator, study.noise)) {
    return tests;
  }
  try {
    tests.refined =
        timeStage("refine the test samples", tests.notes, [&] { return refineAll(study, data, online); });
    const std::string outcome = describe(tests.refined);
    logInfo(fmt::format("refined: {}", outcome));
    warnOfFew(tests.refined, outcome, tests.notes);
  } catch (const std::invalid_argument& error) {
    tests.notes.warn(makeWarning(Notice::kCannotRefine, error.what()));
  }
  return tests;
}

}  // namespace twinmap
