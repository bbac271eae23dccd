#pragma once

#include "framework/spec/experiment_spec.hpp"
#include "framework/spec/fields/fields.hpp"

namespace twinmap {

template <>
struct EnumNames<LeastSquaresStart> {
  static constexpr EnumName<LeastSquaresStart> values[] = {
      {"box_center", LeastSquaresStart::kBoxCenter},
      {"nearest_training", LeastSquaresStart::kNearestTraining},
  };
};

template <class Fields>
void describe(Fields& f, PosteriorSpec& s) {
  f.optional("samples", s.samples, "test samples, the first ones", kHundredThousand);
  f.optional("draws", s.draws, "simulations of each, at least 200", kHundredThousand);
  f.rule(s.draws >= 200, "must give at least 200 draws");
}

template <class Fields>
void describe(Fields&, PriorMeanSpec&) {}

template <class Fields>
void describe(Fields&, LinearRegressionSpec&) {}

template <class Fields>
void describe(Fields& f, LeastSquaresSpec& s) {
  f.optional("samples", s.samples, "test samples, the first ones", kCount);
  f.optional("start", s.start, "where the search begins: box_center, or nearest_training by features");
  f.optional("max_simulations", s.max_simulations, "of each sample", kHundredThousand);
}

template <class Fields>
void describe(Fields& f, BaselineSpec& s) {
  f.optional("prior_mean", s.prior_mean, "what is known without a measurement");
  f.optional("linear_regression", s.linear_regression, "parameters linear in the features");
  f.optional("least_squares", s.least_squares, "classical updating by repeated simulation");
  f.rule(s.prior_mean.has_value() + s.linear_regression.has_value() + s.least_squares.has_value() == 1,
         "must be one of prior_mean, linear_regression, least_squares");
}

template <class Fields>
void describe(Fields& f, EvaluationSpec& s) {
  f.optional("limit", s.limit, "the information limit of every test sample, at 2 p + 1 simulations each");
  f.optional("posterior", s.posterior, "exact posterior of some test samples, by simulation");
  f.optional("baselines", s.baselines, "other inverse maps to compare with");
}

}  // namespace twinmap
