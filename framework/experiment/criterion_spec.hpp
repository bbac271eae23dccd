#pragma once

#include <variant>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

struct DOptimalSpec {};
template <class Fields>
void describe(Fields&, DOptimalSpec&) {}

struct AOptimalSpec {};
template <class Fields>
void describe(Fields&, AOptimalSpec&) {}

struct EOptimalSpec {};
template <class Fields>
void describe(Fields&, EOptimalSpec&) {}

struct ParameterWeight {
  Name name;
  double weight = 0.0;
};

/// The weight of each parameter's variance, by name; those not named weigh nothing.
struct ParameterWeights {
  std::vector<ParameterWeight> values;
};

/// What a design is judged by; variances are in half-widths of the parameters' bounds.
struct CriterionSpec {
  std::variant<DOptimalSpec, AOptimalSpec, EOptimalSpec, Name, ParameterWeights> kind;
};

template <class Fields>
void describe(Fields& f, CriterionSpec& s) {
  f.scalarIsKey();
  f.oneOf("must be one of", choice<DOptimalSpec>("d_optimal", s.kind, "the volume of the joint uncertainty"),
          choice<AOptimalSpec>("a_optimal", s.kind, "the mean variance, relative to the bounds"),
          choice<EOptimalSpec>("e_optimal", s.kind, "the variance of the worst combination"),
          choice<Name>("parameter", s.kind, "the variance of this parameter"),
          choice<ParameterWeights>("weights", s.kind, "the sum of variances with these weights, by name"));
}

}  // namespace twinmap
