#include "framework/experiment/refine_test_samples.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "framework/experiment/refinement_starts.hpp"
#include "framework/monitoring/interrupted.hpp"
#include "framework/monitoring/stage_timer.hpp"
#include "framework/refinement/refine.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

Eigen::VectorXd getKnown(const LabelledFeatures& test, Index i) {
  return test.inputs.rows() > 0 ? Eigen::VectorXd(test.inputs.col(i)) : Eigen::VectorXd();
}

std::vector<RefinementTask> makeTasks(const RefinementContext& context, const Predictions& answers) {
  const LabelledFeatures& test = context.data.labelled.test;
  std::vector<RefinementTask> tasks;
  for (Index i = 0; i < test.features.cols(); ++i) {
    tasks.push_back(makeRefinementTask(context.experiment.model, nullptr, test.features.col(i),
                                       {answers.mean.col(i), {}, getKnown(test, i)}));
  }
  return tasks;
}

/// From what the online map and its trust model say.
std::vector<RefinementTask> makeOnlineTasks(const RefinementContext& context) {
  const LabelledFeatures& test = context.data.labelled.test;
  const OnlineMap map(context.online->map);
  OnlineMap::Workspace inferring(map);
  const TrustModel* trust = context.online->trust ? &*context.online->trust : nullptr;
  std::optional<TrustWorkspace> judging;
  if (trust != nullptr) {
    judging.emplace(*trust);
  }
  std::vector<RefinementTask> tasks;
  for (Index i = 0; i < test.features.cols(); ++i) {
    MapAnswer answer;
    answer.known = getKnown(test, i);
    const Inference& inference = map.infer(test.features.col(i), answer.known, inferring);
    answer.mean = inference.mean;
    if (trust != nullptr) {
      judge(*trust, test.features.col(i), answer.known, inference, *judging);
      answer.explanation = trust->makeSampledPoint(judging->explanation.point);
    }
    tasks.push_back(makeRefinementTask(context.experiment.model, trust, test.features.col(i), answer));
  }
  return tasks;
}

int calcMedian(std::vector<int> values) {
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Index> findAccepted(const std::vector<Refined>& refined) {
  std::vector<Index> accepted;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (refined[i].isAccepted()) {
      accepted.push_back(static_cast<Index>(i));
    }
  }
  return accepted;
}

/// "121 accepted from inverse_map, 5 nonlinear"
std::string describe(const std::vector<Refined>& refined) {
  std::map<std::string, int> counts;
  for (const Refined& one : refined) {
    ++counts[one.isAccepted() ? "accepted from " + one.start : toString(one.status)];
  }
  std::string text;
  for (const auto& [name, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  }
  return text;
}

/// A warning where a user would not get a refined answer to one measurement in ten or more.
void warnOfFew(const std::vector<Refined>& refined, const std::string& outcome, StageNotes& notes) {
  constexpr double kLeast = 0.9;
  const std::size_t accepted = findAccepted(refined).size();
  if (static_cast<double>(accepted) < kLeast * static_cast<double>(refined.size())) {
    notes.warnings.push_back(fmt::format(
        "refinement: {} of {} test samples were accepted ({}); answers to the others are the map's alone",
        accepted, refined.size(), outcome));
  }
}

}  // namespace

std::vector<Refined> refineTestSamples(const RefinementContext& context, const Predictions& answers) {
  const RefinementModel model(collectUnknown(context.experiment.model), context.extractor,
                              context.data.noise);
  const auto tasks = context.online != nullptr ? makeOnlineTasks(context) : makeTasks(context, answers);
  return refineWhileHopeful(context.simulator, model, tasks, context.control.threads, [&] {
    if (context.control.abandon != nullptr && *context.control.abandon) {
      throw Interrupted("interrupted during refinement; the simulated samples are kept");
    }
  });
}

std::vector<MethodSummary> compareMethods(const ExperimentSpec& experiment, const Evaluation& evaluation,
                                          const std::vector<Refined>& refined) {
  constexpr Index kFewest = 3;  // for a standard error
  const Index p = evaluation.truth.rows(), n = evaluation.truth.cols();
  const char* map = experiment.inverse_map.findGp() != nullptr ? "inverse_map" : "surrogate";
  std::vector<MethodSummary> methods{{map, n, n, 0, evaluation.metrics}};
  const std::vector<Index> accepted = findAccepted(refined);
  const auto count = static_cast<Index>(accepted.size());
  std::vector<int> simulations;
  for (const Refined& one : refined) {
    simulations.push_back(one.simulations);
  }
  MethodSummary summary{"refined", n, count, calcMedian(simulations), {}};
  if (count >= kFewest) {
    Predictions predictions{MatrixXd(p, count), MatrixXd(p, count)};
    for (Index i = 0; i < count; ++i) {
      const Refined& one = refined[static_cast<std::size_t>(accepted[static_cast<std::size_t>(i)])];
      predictions.mean.col(i) = one.point.head(p);
      predictions.stddev.col(i) = one.stddev.head(p);
    }
    const MatrixXd& limit = evaluation.limit_stddev;
    summary.metrics =
        calcMetrics(experiment.model.parameters, evaluation.truth(Eigen::all, accepted), predictions,
                    limit.cols() > 0 ? MatrixXd(limit(Eigen::all, accepted)) : MatrixXd());
  } else {
    summary.metrics.assign(static_cast<std::size_t>(p), {});
  }
  methods.push_back(summary);
  return methods;
}

RefinementReference collectReference(const std::vector<Refined>& refined) {
  RefinementReference reference;
  std::vector<double> unexplained;
  for (const Refined& one : refined) {
    const bool tried = !one.start.empty();
    reference.tried += tried ? 1 : 0;
    if (tried && !one.explained) {
      unexplained.push_back(one.calcReducedChiSquare());
    }
  }
  std::sort(unexplained.begin(), unexplained.end());
  reference.unexplained =
      Eigen::Map<const Eigen::VectorXd>(unexplained.data(), static_cast<Index>(unexplained.size()));
  return reference;
}

StageNotes evaluateRefinement(const RefinementContext& context, Evaluation& evaluation) {
  StageNotes notes;
  if (!shouldRefine(context.experiment.refine, context.simulator, context.extractor, context.data.noise)) {
    return notes;
  }
  try {
    const std::vector<Refined> refined = timeStage(
        "refine the test samples", notes, [&] { return refineTestSamples(context, evaluation.predictions); });
    const std::string outcome = describe(refined);
    spdlog::info("refined: {}", outcome);
    warnOfFew(refined, outcome, notes);
    evaluation.refined = refined;
    evaluation.methods = compareMethods(context.experiment, evaluation, refined);
  } catch (const std::invalid_argument& error) {
    notes.warnings.push_back(std::string("test samples cannot be refined: ") + error.what());
  }
  return notes;
}

}  // namespace twinmap
