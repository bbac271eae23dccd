#pragma once

#include <optional>
#include <vector>

#include "framework/experiment/criterion_spec.hpp"

namespace twinmap {

/// What may be measured.
struct SensorCandidatesSpec {
  std::vector<Name> outputs;
  int count = 0;             ///< outputs to be chosen
  std::optional<int> times;  ///< sample times to be chosen of those that the features have; default all
};

template <class Fields>
void describe(Fields& f, SensorCandidatesSpec& s) {
  f.required("outputs", s.outputs, "outputs to choose from, each with noise.stddev");
  f.required("count", s.count, "outputs that can be measured", kCount);
  f.optional("times", s.times, "sample times, of those that the samples of the features have; default all",
             kSampleCount);
  f.rule(s.count <= static_cast<int>(s.outputs.size()), "must not ask for more outputs than there are");
}

/// Which outputs, and when, tell most about the parameters.
struct SensorDesignSpec {
  SensorCandidatesSpec candidates;
  CriterionSpec criterion;
  int average_over = 32;  ///< points of the box
};

template <class Fields>
void describe(Fields& f, SensorDesignSpec& s) {
  f.required("candidates", s.candidates, "what may be measured");
  f.optional("criterion", s.criterion, "what a choice is judged by");
  f.optional("average_over", s.average_over, "points within the bounds that the criterion is averaged over",
             kThousand);
}

}  // namespace twinmap
