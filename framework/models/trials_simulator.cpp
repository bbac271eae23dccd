#include "framework/models/trials_simulator.hpp"

#include <algorithm>
#include <limits>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

namespace {

/// Where what a trial samples stands in the points of all: by the trial's name where it is its own.
std::vector<Index> findSampled(const TrialModel& trial, const std::vector<ParameterSpec>& all) {
  std::vector<Index> found;
  for (const ParameterSpec& one : collectSampled(trial.model)) {
    const std::string own = nameInTrial(trial.name, one.name.text);
    const auto place = std::find_if(all.begin(), all.end(), [&](const ParameterSpec& other) {
      return other.name.text == own || other.name.text == one.name.text;
    });
    found.push_back(place - all.begin());
  }
  return found;
}

VectorXd takeTimes(const VectorXd& times, double duration) {
  return times.head(std::upper_bound(times.begin(), times.end(), duration) - times.begin());
}

}  // namespace

TrialsSimulator::TrialsSimulator(const ModelSpec& model, const VectorXd& times, int modes,
                                 const Maker& make) {
  const std::vector<ParameterSpec> all = collectSampled(model);
  layout_.times = times;
  layout_.modes = modes;
  Index outputs = 0;
  for (const TrialModel& trial : model.trials) {
    trials_.push_back(
        {trial.name,
         make(trial.model, takeTimes(times, trial.model.simulation.duration), std::min(modes, trial.modes)),
         findSampled(trial, all), outputs});
    outputs += static_cast<Index>(trial.model.outputs.size());
    const Simulator& simulator = *trials_.back().simulator;
    const std::vector<std::string>& units = simulator.getLayout().output_units;
    layout_.output_units.insert(layout_.output_units.end(), units.begin(), units.end());
    layout_.output_units.resize(static_cast<std::size_t>(outputs));  // of modes alone
    const std::string& engine = simulator.getEngine();
    if (engine_.find(engine) == std::string::npos) {
      engine_ += (engine_.empty() ? "" : ", ") + engine;
    }
  }
  if (times.size() > 0) {
    layout_.output_names = collectNames(model.outputs);
  } else {
    layout_.output_units.clear();
  }
}

TrialsSimulator::TrialsSimulator(const TrialsSimulator& other, std::vector<Trial> trials)
    : layout_(other.layout_), trials_(std::move(trials)), engine_(other.engine_) {}

void TrialsSimulator::place(const Trial& trial, const Ref<const MatrixXd>& own, Ref<MatrixXd> all) const {
  const ResponseLayout& layout = trial.simulator->getLayout();
  const Index times = layout.times.size(), later = layout_.times.size() - times;
  for (Index o = 0; o < layout.getOutputCount(); ++o) {
    const Index row = layout_.getRow(trial.first_output + o, 0);
    all.middleRows(row, times) = own.middleRows(layout.getRow(o, 0), times);
    if (times > 0) {
      all.middleRows(row + times, later).rowwise() = own.row(layout.getRow(o, times - 1));
    }
  }
  if (layout.modes > 0) {
    all.middleRows(layout_.getFrequencyRow(0), layout.modes) =
        own.middleRows(layout.getFrequencyRow(0), layout.modes);
    all.middleRows(layout_.getDampingRow(0), layout.modes) =
        own.middleRows(layout.getDampingRow(0), layout.modes);
  }
}

template <class Run>
void TrialsSimulator::simulateEach(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                   SampleStatus* statuses, const Run& run) {
  const Index count = parameters.cols();
  std::fill_n(statuses, count, SampleStatus{});
  responses.setZero();  // of a trial without times
  std::vector<SampleStatus> own(static_cast<std::size_t>(count));
  for (const Trial& trial : trials_) {
    MatrixXd rows(trial.simulator->getLayout().getRowCount(), count);
    run(trial, parameters(trial.sampled, Eigen::all), rows, own.data());
    place(trial, rows, responses);
    for (Index i = 0; i < count; ++i) {
      SampleStatus& status = statuses[i];
      const SampleStatus& of_trial = own[static_cast<std::size_t>(i)];
      status.stiff_retry = status.stiff_retry || of_trial.stiff_retry;
      if (status.ok && !of_trial.ok) {
        status = of_trial;
        status.reason = "trial '" + trial.name + "': " + of_trial.reason;
      }
    }
  }
  for (Index i = 0; i < count; ++i) {
    if (!statuses[i].ok) {
      responses.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
}

void TrialsSimulator::simulate(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                               SampleStatus* statuses) {
  simulateEach(parameters, responses, statuses,
               [](const Trial& trial, const MatrixXd& points, MatrixXd& rows, SampleStatus* own) {
                 trial.simulator->simulate(points, rows, own);
               });
}

void TrialsSimulator::simulateAround(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                     SampleStatus* statuses) {
  simulateEach(parameters, responses, statuses,
               [](const Trial& trial, const MatrixXd& points, MatrixXd& rows, SampleStatus* own) {
                 trial.simulator->simulateAround(points, rows, own);
               });
}

void TrialsSimulator::simulateWithDerivatives(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                              MatrixXd& derivatives, SampleStatus* statuses) {
  const Index sampled = parameters.rows(), count = parameters.cols();
  derivatives.setZero(layout_.getRowCount(), count * sampled);
  simulateEach(parameters, responses, statuses,
               [&](const Trial& trial, const MatrixXd& points, MatrixXd& rows, SampleStatus* own) {
                 MatrixXd slopes;
                 trial.simulator->simulateWithDerivatives(points, rows, slopes, own);
                 const Index of_trial = points.rows();
                 for (Index i = 0; i < count; ++i) {
                   for (Index k = 0; k < of_trial; ++k) {
                     place(trial, slopes.col(i * of_trial + k),
                           derivatives.col(i * sampled + trial.sampled[static_cast<std::size_t>(k)]));
                   }
                 }
               });
}

int TrialsSimulator::getBatchSize() const {
  int size = 1;
  for (const Trial& trial : trials_) {
    size = std::max(size, trial.simulator->getBatchSize());
  }
  return size;
}

bool TrialsSimulator::mixesNeighbours() const {
  return std::all_of(trials_.begin(), trials_.end(),
                     [](const Trial& trial) { return trial.simulator->mixesNeighbours(); });
}

bool TrialsSimulator::hasDerivatives() const {
  return std::all_of(trials_.begin(), trials_.end(),
                     [](const Trial& trial) { return trial.simulator->hasDerivatives(); });
}

std::unique_ptr<Simulator> TrialsSimulator::clone() const {
  std::vector<Trial> trials;
  for (const Trial& trial : trials_) {
    trials.push_back({trial.name, trial.simulator->clone(), trial.sampled, trial.first_output});
  }
  return std::unique_ptr<Simulator>(new TrialsSimulator(*this, std::move(trials)));
}

std::unique_ptr<Simulator> TrialsSimulator::clonePrecisely() const {
  std::vector<Trial> trials;
  for (const Trial& trial : trials_) {
    std::unique_ptr<Simulator> precise = trial.simulator->clonePrecisely();
    if (!precise) {
      return nullptr;
    }
    trials.push_back({trial.name, std::move(precise), trial.sampled, trial.first_output});
  }
  return std::unique_ptr<Simulator>(new TrialsSimulator(*this, std::move(trials)));
}

std::string TrialsSimulator::describeDifferences() {
  std::string text;
  for (const Trial& trial : trials_) {
    if (const std::string own = trial.simulator->describeDifferences(); !own.empty()) {
      text += (text.empty() ? "" : "; ") + trial.name + ": " + own;
    }
  }
  return text;
}

void TrialsSimulator::checkStart() {
  for (const Trial& trial : trials_) {
    trial.simulator->checkStart();
  }
}

}  // namespace twinmap
