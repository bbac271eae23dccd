#pragma once

#include <vector>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/simulation/excitation/excitation_terms.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap {

/// Excitation signals written down. What switches between phases is a phase input: the flag of a term, 1
/// while it is on; of a table the polynomial of the interval. Everything else follows from parameters and the
/// time, so that its derivatives do, too.
struct RecordedExcitation {
  /// On for events[begin] <= t < events[end]; -1: to the end.
  struct Term {
    int flag, begin, end;
  };
  /// The piece's begin and its first `degree` + 1 values are the inputs from `first_input` on. `zero`: the
  /// event that is the time 0 of the table's own clock; -1: t = 0.
  struct Table {
    int first_input, degree;
    std::vector<TablePiece> pieces;  ///< by increasing begin, in times of the table's clock
    int zero = -1;

    double getZero(const std::vector<double>& event_times) const {
      return zero < 0 ? 0.0 : event_times[static_cast<std::size_t>(zero)];
    }
  };

  std::vector<program::Symbol> signals;
  std::vector<program::Symbol> events;  ///< s; of parameters alone
  std::vector<Term> terms;
  std::vector<Table> tables;
  int input_count = 0;
  program::Symbol clock;  ///< the excitation's time; that of the integration where origin_input is -1, else
                          ///< so much later
  int origin_input = -1;  ///< ModelSpec::time_origin
};

/// `names`: parameters and constants; has_origin: whether the excitation's time begins at a phase input.
RecordedExcitation recordExcitation(const std::vector<SignalSpec>& signals, program::Recorder& recorder,
                                    const NamedValues<program::Symbol>& names, bool has_origin);

/// A time of the excitation at which a phase begins, s; `event`: the one of parameters that it is, or -1.
struct Boundary {
  double time;
  int event;
};

/// `first`, the times in (first, last) at which a signal may jump or bend, and `last`; increasing, each once.
/// `events`: values of RecordedExcitation::events. Cost: that of those in between.
std::vector<Boundary> calcBoundaries(const RecordedExcitation& excitation, const std::vector<double>& events,
                                     double first, double last);

/// The phase inputs of the phase that begins at `begin` (input_count of them), of a simulation that begins at
/// `origin`.
void fillPhaseInputs(const RecordedExcitation& excitation, const std::vector<double>& events, double begin,
                     double* inputs, double origin = 0.0);

}  // namespace twinmap
