#include "framework/study/pipeline/training/train_map.hpp"

#include "framework/base/log/notice.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/study/pipeline/training/train_interruptibly.hpp"

namespace twinmap {
namespace {

std::string join(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) {
    joined += (joined.empty() ? "" : "; ") + text;
  }
  return joined;
}

std::vector<TrainingStart> summarizeTraining(const std::vector<std::string>& parameters,
                                             const std::vector<gp::TrainingReport>& reports) {
  std::vector<TrainingStart> rows;
  for (std::size_t p = 0; p < reports.size(); ++p) {
    for (std::size_t k = 0; k < reports[p].starts.size(); ++k) {
      const gp::StartReport& start = reports[p].starts[k];
      const bool best = static_cast<int>(k) == reports[p].best_start;
      rows.push_back({parameters[p], static_cast<int>(k), best, start.nlml, start.evaluations,
                      start.noise_only, start.stop_reason, best ? join(reports[p].at_bound) : "",
                      reports[p].condition, reports[p].jitter});
    }
  }
  return rows;
}

std::vector<TrainedHyperparameter> listHyperparameters(const std::vector<std::string>& parameters,
                                                       const std::vector<gp::TrainingReport>& reports) {
  std::vector<TrainedHyperparameter> listed;
  for (std::size_t p = 0; p < reports.size(); ++p) {
    for (const gp::BoundedHyperparameter& of : reports[p].hyperparameters) {
      listed.push_back({parameters[p], of.name, of.value, of.lower, of.upper});
    }
  }
  return listed;
}

}  // namespace

Training makeTraining(const ExperimentSpec& experiment, const LabelledFeatures& samples,
                      GpMapTraining trained) {
  const std::vector<std::string> names = collectNames(experiment.model.parameters);
  Training training;
  for (const std::string& warning : trained.warnings) {
    training.notes.warn(makeWarning(Notice::kUnfinishedTraining, warning));
  }
  training.summary.leave_one_out = calcMetrics(experiment.model.parameters, samples.parameters,
                                               trained.leave_one_out, {}, samples.replicates);
  training.summary.starts = summarizeTraining(names, trained.reports);
  training.summary.hyperparameters = listHyperparameters(names, trained.reports);
  for (const gp::Process& process : trained.map.processes) {
    training.summary.nlml.push_back(gp::getNlml(process));
  }
  training.map = std::move(trained.map);
  return training;
}

Training trainMap(const Study& study, const LabelledFeatures& samples) {
  const ExperimentSpec& experiment = study.experiment;
  StageNotes notes;
  GpMapTraining trained = timeStage("train the inverse map", notes, [&] {
    return trainInterruptibly([&] {
      return trainGpMap(*experiment.inverse_map.findProcesses(), experiment.transform,
                        collectNames(experiment.model.parameters), samples, study.getTrainingControl(),
                        experiment.model.inputs);
    });
  });
  Training training = makeTraining(experiment, samples, std::move(trained));
  training.notes.times = notes.times;
  return training;
}

}  // namespace twinmap
