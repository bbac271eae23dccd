#pragma once

#include <optional>
#include <vector>

#include "framework/experiment/criterion_spec.hpp"
#include "framework/experiment/model/bounds_spec.hpp"

namespace twinmap {

/// A value of the excitation that a design may choose: a key path below `excitation`, and its bounds.
struct FreeValue {
  Name key;           ///< "F.pulses[0].start"
  bool each = false;  ///< the key is a list, whose entries are free one by one
  Bounds bounds;
};

struct FreeValues {
  std::vector<FreeValue> values;
};

/// What a design must not exceed: an output in every simulation within the bounds, or a signal.
struct DesignLimitSpec {
  std::optional<Name> output, signal;
  std::optional<double> max_abs;   ///< in its unit
  std::optional<double> max_rate;  ///< of a signal: its unit per s
  std::optional<double> rms;       ///< of a signal, over the simulation
  SourceLocation where;
};

template <class Fields>
void describe(Fields& f, DesignLimitSpec& s) {
  f.location(s.where);
  f.oneOf("must give exactly one of", choice("output", s.output, "in every simulation within the bounds"),
          choice("signal", s.signal, "of the excitation"));
  f.optional("max_abs", s.max_abs, "largest absolute value", kPositive);
  f.optional("max_rate", s.max_rate, "of a signal: largest change per second; jumps exceed every rate",
             kPositive);
  f.optional("rms", s.rms, "of a signal: root mean square over the simulation", kPositive);
  f.rule(s.max_abs || s.max_rate || s.rms, "must give at least one of max_abs, max_rate, rms");
  f.rule(s.signal || (!s.max_rate && !s.rms), "must give max_rate and rms of a signal only");
}

/// Values of the excitation to be chosen so that the experiment tells most about the parameters.
struct ExcitationDesignSpec {
  FreeValues free;
  CriterionSpec criterion;
  std::vector<DesignLimitSpec> limits;
  int average_over = 32;  ///< points of the box
  int budget = 2000;      ///< designs that are tried
};

template <class Fields>
void describe(Fields& f, ExcitationDesignSpec& s) {
  f.required("free", s.free, "values below excitation, by key path, with their bounds");
  f.optional("criterion", s.criterion, "what a design is judged by");
  f.optional("limits", s.limits, "what outputs and signals must not exceed");
  f.optional("average_over", s.average_over, "points within the bounds that the criterion is averaged over",
             kThousand);
  f.optional("budget", s.budget, "designs that are tried", kHundredThousand);
}

}  // namespace twinmap
