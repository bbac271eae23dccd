#include "framework/models/mechanism/lanes/recording/recorded_model.hpp"

#include <algorithm>
#include <utility>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/equations/outputs.hpp"
#include "framework/models/mechanism/equilibrium.hpp"
#include "framework/models/mechanism/lanes/recording/controller_rest.hpp"
#include "framework/models/mechanism/recorded_parameters.hpp"
#include "framework/models/mechanism/sampled_keys.hpp"
#include "kernels/lanes/program/differentiate.hpp"

namespace twinmap {
namespace {

using equations::ModelMotion;
using equations::ModelState;
using equations::SystemValues;
using program::Symbol;
using Symbols = RecordedModel::Symbols;

/// Of Newton's method towards the conditions: where outputs are taken, interpolation leaves larger distances
/// than a step does.
constexpr int kStepRounds = 1, kOutputRounds = 2;

/// Where states leave the conditions in implicit integration, they are led back so many times a duration.
constexpr double kRelaxations = 1e4;

class ModelRecorder {
 public:
  ModelRecorder(const ModelSpec& model, const SystemNames& names, std::shared_ptr<const LoopModel> loops)
      : model_(model),
        names_(names),
        loops_(std::move(loops)),
        recorder_(std::make_unique<program::Recorder>()),
        rate_orders_(countSignalRates(model)) {
    values_ = recordParameters(model, *recorder_);
    system_ = equations::calcSystemValues(model.system, names, values_);
    mode_count_ = equations::countSwitches(system_.elements);
    keepIndependent();
  }

  RecordedModel record(bool with_rest) {
    RecordedModel recorded;
    recorded.parameter_count = static_cast<int>(countSampled(model_));
    recorded.origin_parameter = findOrigin();
    recorded.coordinate_count = system_.coordinate_count;
    recorded.state_count = system_.state_count;
    recorded.excitation =
        recordExcitation(model_.excitation, *recorder_, values_, model_.time_origin.has_value());
    clock_ = recorded.excitation.clock;
    signals_ = recorded.excitation.signals;
    signal_rates_ = calcRates(signals_);
    recordMotion(recorded);
    recorded.mode_count = mode_count_ + static_cast<int>(watched_.size());
    recordOutputs(recorded);
    recordSwitches(recorded);
    if (with_rest) {
      recordRest(recorded);
    }
    recorded.initial = recordInitial();
    recorded.initial.resize(recorded.derivatives.size(), Symbol(0.0));
    recorded.loops = loops_;
    recorded.prescribed = findPrescribed();
    recorded.recorder = std::move(recorder_);
    return recorded;
  }

 private:
  Symbols getStates(int first, int count) {
    Symbols states;
    for (int i = 0; i < count; ++i) {
      states.push_back(recorder_->state(first + i));
    }
    return states;
  }
  Symbols getCoordinates() { return getStates(0, system_.coordinate_count); }
  Symbols getSpeeds() { return getStates(system_.coordinate_count, system_.coordinate_count); }
  Symbols getFirstOrder() { return getStates(2 * system_.coordinate_count, system_.state_count); }
  int countKnown() const { return 2 * system_.coordinate_count + system_.state_count; }
  Symbols getModes() { return getStates(countKnown(), mode_count_); }

  ModelMotion<Symbol> calcMotion(const ModelState<Symbol>& state) {
    return equations::calcModelMotion(model_, names_, values_, system_, state);
  }

  int findOrigin() const {
    const std::vector<ParameterSpec> sampled = collectSampled(model_);
    const auto found = std::find_if(sampled.begin(), sampled.end(), [this](const ParameterSpec& one) {
      return model_.time_origin && one.name.text == model_.time_origin->text;
    });
    return found == sampled.end() ? -1 : static_cast<int>(found - sampled.begin());
  }

  /// Of the conditions of constraints; all where nothing is known.
  void keepIndependent() {
    if (loops_) {
      std::vector<equations::Closure<Symbol>> kept;
      for (const int row : loops_->plan.rows) {
        kept.push_back(system_.closures[row]);
      }
      system_.closures = std::move(kept);
    }
  }

  void recordMotion(RecordedModel& recorded) {
    const ModelMotion<Symbol> motion = calcMotion(makeState(getFirstOrder()));
    recorded.derivatives = motion.rates;
    append(motion.accelerations, recorded.derivatives);
    append(motion.state_rates, recorded.derivatives);
    holdPrescribed(recorded.derivatives);
    recorded.pivots = motion.pivots;
    recordWatched(motion);
    if (!system_.closures.empty()) {
      recordProjected(recorded);
    }
  }

  /// What rests, sticks or flies may move by polynomials or not at all while signals swing, so that steps as
  /// long as the error of the motion allows would pass over events. What makes these is integrated too: the
  /// speed that what is held would have gained, and the depths of touches.
  void recordWatched(const ModelMotion<Symbol>& motion) {
    const std::vector<std::string> used = listUsedNames(model_);
    const bool in_time = !signals_.empty() || std::find(used.begin(), used.end(), "t") != used.end();
    if (mode_count_ > 0 && in_time) {
      watched_ = motion.held_back;
      for (const auto& touch : equations::calcTouches(system_, makeState(getFirstOrder()), motion)) {
        watched_.push_back(touch.rate);
      }
    }
  }

  /// What the signals say is not integrated.
  void holdPrescribed(Symbols& derivatives) const {
    for (const int i : findPrescribed()) {
      derivatives[i] = derivatives[system_.coordinate_count + i] = 0.0;
    }
  }

  /// What is wanted of states that have left the conditions of loops a little.
  void recordProjected(RecordedModel& recorded) {
    const ModelState<Symbol> state = makeState(getFirstOrder());
    const ModelState<Symbol> projected = project(state, kStepRounds);
    recorded.projected = joinStates(projected);
    const ModelMotion<Symbol> motion = calcMotion(projected);
    recorded.relaxed = motion.rates;
    append(motion.accelerations, recorded.relaxed);
    append(motion.state_rates, recorded.relaxed);
    const Symbols given = joinStates(state);
    for (std::size_t i = 0; i < given.size(); ++i) {
      recorded.relaxed[i] += kRelaxations / model_.simulation.duration * (recorded.projected[i] - given[i]);
    }
    holdPrescribed(recorded.relaxed);
  }

  ModelState<Symbol> project(ModelState<Symbol> state, int rounds) {
    auto [coordinates, speeds] =
        equations::project(system_, state.coordinates, state.speeds, rounds, findPrescribed());
    state.coordinates = std::move(coordinates);
    state.speeds = std::move(speeds);
    return state;
  }

  static Symbols joinStates(const ModelState<Symbol>& state) {
    Symbols all = state.coordinates;
    append(state.speeds, all);
    append(state.states, all);
    return all;
  }

  /// The modes of switches, what is watched of them and the hidden states of sensors and controllers stand
  /// behind all others, and no condition concerns them. What is sampled changes no mode.
  void recordOutputs(RecordedModel& recorded) {
    recorded.sampling =
        recordSampling({model_, names_, values_, *recorder_, getStates(0, countKnown() + recorded.mode_count),
                        makeState(getFirstOrder()).coordinates, signals_, recorded.excitation.input_count,
                        [this](Symbols first_order) {
                          first_order.resize(system_.state_count);
                          return calcQuantities(makeState(std::move(first_order)));
                        }});
    Symbols rates(mode_count_, Symbol(0.0));
    append(watched_, rates);
    append(recorded.sampling.hidden_rates, rates);
    append(rates, recorded.derivatives);
    if (!recorded.projected.empty()) {
      append(getStates(countKnown(), static_cast<int>(rates.size())), recorded.projected);
      append(rates, recorded.relaxed);
    }
  }

  void recordSwitches(RecordedModel& recorded) {
    if (mode_count_ == 0) {
      return;
    }
    const int input = recorded.sampling.input_count++, hidden = countKnown() + mode_count_;
    recorded.events = recordEvents({system_, makeState(getFirstOrder()),
                                    getStates(hidden, static_cast<int>(recorded.derivatives.size()) - hidden),
                                    recorder_->phaseInput(input), model_.simulation.duration,
                                    [this](const ModelState<Symbol>& state) { return calcMotion(state); },
                                    [this](const StateNumber<Symbol>& level) { return calcLevel(level); }});
    recorded.events.input = input;
  }

  Symbols calcQuantities(const ModelState<Symbol>& given) {
    const ModelState<Symbol> state = system_.closures.empty() ? given : project(given, kOutputRounds);
    const ModelMotion<Symbol> motion = calcMotion(state);
    const NamedValues<Symbol> named =
        equations::hasExpression(model_.outputs) || equations::hasForce(model_.outputs)
            ? nameAll(state, motion)
            : values_;
    Symbols quantities;
    for (const OutputSpec& output : model_.outputs) {
      quantities.push_back(equations::calcOutput(output, names_, named, system_, state, motion));
    }
    return quantities;
  }

  std::vector<int> findPrescribed() const {
    std::vector<int> coordinates;
    for (const MotionSpec& motion : model_.system.motions) {
      coordinates.push_back(names_.findCoordinate(motion.coordinate));
    }
    return coordinates;
  }

  /// In motion, with prescribed coordinates as their signals say.
  ModelState<Symbol> makeState(Symbols first_order) {
    ModelState<Symbol> state{clock_,   getCoordinates(), getSpeeds(), std::move(first_order),
                             signals_, signal_rates_};
    for (const MotionSpec& motion : model_.system.motions) {
      const int i = names_.findCoordinate(motion.coordinate);
      const Symbol& signal = signals_[findSignal(model_, motion.follows)];
      const std::vector<program::Seed> in_time{{recorder_->time(), 1.0}};
      state.coordinates[i] = signal;
      state.speeds[i] = program::calcTangents({signal}, in_time)[0];
      state.prescribed.push_back({i, program::calcTangents({state.speeds[i]}, in_time)[0]});
    }
    state.modes = getModes();
    return state;
  }

  NamedValues<Symbol> nameState(const ModelState<Symbol>& state,
                                const std::vector<equations::BodyMotion<Symbol>>& bodies,
                                const Symbols& rates) const {
    return equations::nameState(model_, names_, system_, bodies, state, rates, values_);
  }

  /// Of friction, in the recorder's state.
  Symbol calcLevel(const StateNumber<Symbol>& level) {
    if (level.varying == nullptr) {
      return level.value;
    }
    const ModelState<Symbol> state = makeState(getFirstOrder());
    const Symbols rates = equations::calcRates(system_, state.coordinates, state.speeds);
    const auto bodies = equations::calcMotions(system_, state.coordinates, state.speeds);
    return nameState(state, bodies, rates).calc(*level.varying);
  }

  /// Time derivatives of signals, of the orders that are used.
  Symbols calcRates(Symbols signals) {
    Symbols rates;
    for (int order = 0; order < rate_orders_; ++order) {
      signals = program::calcTangents(signals, {{recorder_->time(), 1.0}});
      append(signals, rates);
    }
    return rates;
  }

  /// What expressions of outputs may use.
  NamedValues<Symbol> nameAll(const ModelState<Symbol>& state, const ModelMotion<Symbol>& motion) {
    NamedValues<Symbol> named = nameState(state, motion.bodies, motion.rates);
    const Symbols second =
        system_.closures.empty()
            ? calcSecondDerivatives(state, motion)
            : equations::calcSecondRates(system_, state.coordinates, motion.rates, motion.accelerations);
    for (std::size_t i = 0; i < second.size(); ++i) {
      named.set(names_.getCoordinateNames()[i] + "_ddot", second[i]);
    }
    return named;
  }

  ModelState<Symbol> makeQuietState(Symbols speeds) {
    ModelState<Symbol> state{0.0,
                             getCoordinates(),
                             std::move(speeds),
                             getFirstOrder(),
                             Symbols(model_.excitation.size(), Symbol(0.0)),
                             Symbols(rate_orders_ * model_.excitation.size(), Symbol(0.0))};
    for (const int i : findPrescribed()) {
      state.prescribed.push_back({i, 0.0});
    }
    return state;
  }

  void recordRest(RecordedModel& recorded) {
    const int n = system_.coordinate_count;
    const ModelState<Symbol> quiet = makeQuietState(Symbols(n, Symbol(0.0)));
    ModelMotion<Symbol> rest = calcMotion(quiet);
    if (!model_.system.controllers.empty()) {
      addControllersAtRest(model_, names_, values_, quiet, calcQuantitiesAtRest(quiet, rest),
                           rest.state_rates);
    }
    recorded.rest_rates = rest.accelerations;
    append(rest.state_rates, recorded.rest_rates);
    recorded.rest_pivots = rest.pivots;
    for (const auto& terms : equations::calcClosureTerms(system_, rest.bodies, getCoordinates())) {
      recorded.rest_closures.push_back(kClosureWeight * terms.value);
    }
    const ModelState<Symbol> moving = makeQuietState(getSpeeds());
    const ModelMotion<Symbol> motion = calcMotion(moving);
    Symbols changes = calcSecondDerivatives(moving, motion);
    append(motion.state_rates, changes);
    for (int i = 0; i < n; ++i) {
      append(program::calcTangents(changes, {{moving.coordinates[i], 1.0}}), recorded.linearization);
    }
    for (int i = 0; i < n; ++i) {
      append(program::calcTangents(changes, makeRateSeeds(moving, i)), recorded.linearization);
    }
    for (const Symbol& state : moving.states) {
      append(program::calcTangents(changes, {{state, 1.0}}), recorded.linearization);
    }
  }

  Symbols calcQuantitiesAtRest(const ModelState<Symbol>& quiet, const ModelMotion<Symbol>& rest) const {
    NamedValues<Symbol> named = nameState(quiet, rest.bodies, rest.rates);
    for (const std::string& coordinate : names_.getCoordinateNames()) {
      named.set(coordinate + "_ddot", Symbol(0.0));
    }
    Symbols quantities;
    for (const OutputSpec& output : model_.outputs) {
      quantities.push_back(equations::calcOutput(output, names_, named, system_, quiet, rest));
    }
    return quantities;
  }

  static void append(const Symbols& more, Symbols& symbols) {
    symbols.insert(symbols.end(), more.begin(), more.end());
  }

  /// Second time derivatives of the coordinates; the state must be the recorder's.
  static Symbols calcSecondDerivatives(const ModelState<Symbol>& state, const ModelMotion<Symbol>& motion) {
    std::vector<program::Seed> seeds;
    for (std::size_t i = 0; i < state.coordinates.size(); ++i) {
      seeds.push_back({state.coordinates[i], motion.rates[i]});
      seeds.push_back({state.speeds[i], motion.accelerations[i]});
    }
    return program::calcTangents(motion.rates, seeds);
  }

  /// How the speeds change with one coordinate's rate.
  std::vector<program::Seed> makeRateSeeds(const ModelState<Symbol>& state, int coordinate) {
    Symbols rates(state.speeds.size(), Symbol(0.0));
    rates[coordinate] = 1.0;
    const Symbols speeds = equations::calcSpeeds(system_, state.coordinates, rates);
    std::vector<program::Seed> seeds;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      seeds.push_back({state.speeds[i], speeds[i]});
    }
    return seeds;
  }

  Symbols calcNamed(const std::vector<NamedExpression>& given) {
    Symbols values(system_.coordinate_count, Symbol(0.0));
    for (const NamedExpression& value : given) {
      values[names_.findCoordinate(value.name)] = values_.calc(value.value);
    }
    return values;
  }

  Symbols recordInitial() {
    Symbols coordinates = calcNamed(model_.initial.coordinates);
    Symbols rates = calcNamed(model_.initial.speeds);
    if (model_.initial.equilibrium) {
      rates.assign(rates.size(), Symbol(0.0));
    }
    for (const MotionSpec& motion : model_.system.motions) {
      const int i = names_.findCoordinate(motion.coordinate);
      coordinates[i] = signals_[findSignal(model_, motion.follows)];
      rates[i] = program::calcTangents({coordinates[i]}, {{recorder_->time(), 1.0}})[0];
    }
    append(loops_ ? rates : equations::calcSpeeds(system_, coordinates, rates), coordinates);
    for (const StateSpec& state : model_.system.states) {
      coordinates.push_back(values_.calc(state.initial));
    }
    system_.elements.forEachList([&](const auto& list) {
      for (const auto& element : list) {
        forEachOwnState(element, [&](const auto& part, int) { coordinates.push_back(part.initial); });
      }
    });
    return coordinates;
  }

  const ModelSpec& model_;
  const SystemNames& names_;
  std::shared_ptr<const LoopModel> loops_;
  std::unique_ptr<program::Recorder> recorder_;
  NamedValues<Symbol> values_;
  SystemValues<Symbol> system_;
  Symbol clock_;
  Symbols signals_, signal_rates_;
  Symbols watched_;  ///< rates, of states behind the modes
  int mode_count_ = 0;
  const int rate_orders_;  ///< of signals
};

}  // namespace

RecordedModel recordModel(const ModelSpec& model, const SystemNames& names,
                          std::shared_ptr<const LoopModel> loops) {
  // Derivatives by each coordinate and speed take 30 ms of 8 coordinates, 300 ms of 16, 3 s of 30.
  constexpr std::size_t kManyCoordinates = 8;
  if (model.initial.equilibrium || names.getCoordinates().size() <= kManyCoordinates) {
    return ModelRecorder(model, names, std::move(loops)).record(true);
  }
  RecordedModel recorded = ModelRecorder(model, names, loops).record(false);
  recorded.record_with_rest = [&model, names, loops] {
    return ModelRecorder(model, names, loops).record(true);
  };
  return recorded;
}

}  // namespace twinmap
