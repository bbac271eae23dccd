#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "framework/experiment/model/excitation_spec.hpp"
#include "framework/simulation/excitation/cubic_spline.hpp"
#include "framework/simulation/excitation/excitation_terms.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// value + slope * elapsed: of a table between two of its times
struct LineShape {
  double value, slope;

  double calc(double elapsed) const { return value + slope * elapsed; }
  double calcRate(double) const { return slope; }
  double calcSecondRate(double) const { return 0.0; }
};

struct SplineShape {
  const CubicSpline* spline;

  double calc(double elapsed) const { return spline->calc(elapsed); }
  double calcRate(double elapsed) const { return spline->calcSlope(elapsed); }
  double calcSecondRate(double elapsed) const { return spline->calcCurvature(elapsed); }
};

/// A function, smooth enough to integrate across, that is switched on for begin <= t < end.
struct ExcitationTerm {
  int signal;
  double begin, end;  ///< s; end may be infinity
  std::variant<PulseShape<double>, ToneShape<double>, ChirpShape<double>, LineShape, SplineShape> shape;
};

/// The splines of cubic tables, which no parameter changes.
using TableSplines = std::map<const TableSpec*, CubicSpline>;

/// Excitation signals as sums of smooth terms. Between two successive event times every signal is a smooth
/// function (through the points of a cubic table with two derivatives), so that the right-hand side of an
/// integration never compares times: it is told when a phase begins, and the signal values it reads may be
/// extended smoothly beyond the phase's end.
class Excitation {
 public:
  /// `signals` must outlive the excitation unchanged. Throws ExperimentError for a table whose times decrease
  /// or whose columns differ in length, and for a multisine whose phases do not match its frequencies.
  explicit Excitation(const std::vector<SignalSpec>& signals);
  Excitation(const Excitation&) = delete;
  Excitation& operator=(const Excitation&) = delete;

  /// Evaluates all numbers for a parameter set and mutes the signals. Throws SimulationFailure for a number
  /// that is not finite, an end that is not after its start, or a frequency that is not positive.
  void update(ModelNumbers& numbers);

  /// The times in (0, duration) at which a signal may jump or bend, increasing, each once.
  std::vector<double> calcEventTimes(double duration) const;

  /// Switches on the terms of the phase that begins at `begin`: 0 or an event time. Phases must be entered in
  /// increasing order; mute() before starting again.
  void beginPhase(double begin);
  void mute();  ///< all signals are 0

  int getSignalCount() const { return static_cast<int>(signals_.size()); }

  /// Value of every signal at time t in the current phase; `values` has getSignalCount() entries.
  void calcValues(double t, std::vector<double>& values) const;
  /// The time derivatives likewise, and where `rates` has twice as many entries behind them those of second
  /// order; a jump between two phases has none.
  void calcRates(double t, std::vector<double>& rates) const;

 private:
  const std::vector<SignalSpec>& signals_;
  TableSplines splines_;
  std::vector<ExcitationTerm> terms_;  ///< by increasing begin
  std::vector<const ExcitationTerm*> active_;
  std::size_t next_ = 0;  ///< first term not yet switched on
};

/// Value of a term at time t, whether it is switched on or not.
double calcTerm(const ExcitationTerm& term, double t);

}  // namespace twinmap
