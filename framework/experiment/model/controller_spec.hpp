#pragma once

#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A name that a controller's expressions have for what it reads.
struct ReadingSpec {
  Name name;
  Name source;  ///< an output, with its sensor, or a coordinate
};

template <class Fields>
void describe(Fields& f, ReadingSpec& s) {
  f.value(s.source);
}

/// A state that changes at the controller's instants.
struct DiscreteStateSpec {
  Name name;
  Expression next;  ///< of the readings and of all states before
  Expression initial;
  std::string unit;
};

template <class Fields>
void describe(Fields& f, DiscreteStateSpec& s) {
  f.required("next", s.next, "its value at the next instant; may use readings, states, signals and t",
             kOwnUnit);
  f.optional("initial", s.initial, "its value at the first instant", kOwnUnit);
  f.optional("unit", s.unit, "unit of the state");
}

/// What a controller computes at its instants and holds between them.
struct ControllerOutputSpec {
  Name name;
  Expression value;
  Expression initial;  ///< before the first write
  std::string unit;
};

template <class Fields>
void describe(Fields& f, ControllerOutputSpec& s) {
  f.scalarIsValueOf("value");
  f.required("value", s.value, "of the readings and states before; held until the next write", kOwnUnit);
  f.optional("initial", s.initial, "its value before the first write", kOwnUnit);
  f.optional("unit", s.unit, "unit of the output");
}

/// A sampled controller. At t = k sample_time it reads, computes outputs and next states from the states as
/// they were, and shows the outputs a delay later.
struct ControllerSpec {
  Name name;
  double sample_time = 0.0;  ///< s
  Expression delay;          ///< s; 0 or more; may exceed the sample time
  std::vector<ReadingSpec> reads;
  std::vector<DiscreteStateSpec> states;
  std::vector<ControllerOutputSpec> writes;
};

template <class Fields>
void describe(Fields& f, ControllerSpec& s) {
  f.required("sample_time", s.sample_time, "between two instants, the first at t = 0; s", kPositive);
  f.optional("delay", s.delay, "from reading to the new output", Unit{"s"});
  f.optionalMap("reads", s.reads, "outputs, with their sensors, or coordinates, by names of its own");
  f.optionalMap("states", s.states, "discrete states");
  f.requiredMap("writes", s.writes, "outputs, for all expressions that may use states");
}

}  // namespace twinmap
