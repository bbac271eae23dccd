#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"
#include "framework/experiment/inverse_map_spec.hpp"

namespace twinmap {

/// The exact posterior of some test samples by importance sampling of the simulator.
struct PosteriorSpec {
  int samples = 20;  ///< the first that could be simulated
  int draws = 500;   ///< simulations of each, and per round
};

template <class Fields>
void describe(Fields& f, PosteriorSpec& s) {
  f.optional("samples", s.samples, "test samples, the first ones", kHundredThousand);
  f.optional("draws", s.draws, "simulations of each, at least 200", kHundredThousand);
  f.rule(s.draws >= 200, "must give at least 200 draws");
}

struct PriorMeanSpec {};

template <class Fields>
void describe(Fields&, PriorMeanSpec&) {}

struct LinearRegressionSpec {};

template <class Fields>
void describe(Fields&, LinearRegressionSpec&) {}

enum class LeastSquaresStart { kBoxCenter, kNearestTraining };

template <>
struct EnumNames<LeastSquaresStart> {
  static constexpr EnumName<LeastSquaresStart> values[] = {
      {"box_center", LeastSquaresStart::kBoxCenter},
      {"nearest_training", LeastSquaresStart::kNearestTraining},
  };
};

/// Classical iterative updating of each test sample by the simulator itself.
struct LeastSquaresSpec {
  int samples = 50;  ///< the first that could be simulated
  LeastSquaresStart start = LeastSquaresStart::kBoxCenter;
  int max_simulations = 500;  ///< of each sample
};

template <class Fields>
void describe(Fields& f, LeastSquaresSpec& s) {
  f.optional("samples", s.samples, "test samples, the first ones", kCount);
  f.optional("start", s.start, "where the search begins: box_center, or nearest_training by features");
  f.optional("max_simulations", s.max_simulations, "of each sample", kHundredThousand);
}

/// An inverse map to compare with, on the same test samples.
using BaselineSpec = std::variant<PriorMeanSpec, LinearRegressionSpec, LeastSquaresSpec>;

template <class Fields>
void describe(Fields& f, BaselineSpec& s) {
  f.scalarIsKey();
  f.oneOf("must be one of", choice<PriorMeanSpec>("prior_mean", s, "what is known without a measurement"),
          choice<LinearRegressionSpec>("linear_regression", s, "parameters linear in the features"),
          choice<LeastSquaresSpec>("least_squares", s, "classical updating by repeated simulation"));
}

/// How the posteriors that `infer --posterior` samples are checked on the test samples.
enum class PosteriorCalibrationMethod { kNone, kSimulationBased };

template <>
struct EnumNames<PosteriorCalibrationMethod> {
  static constexpr EnumName<PosteriorCalibrationMethod> values[] = {
      {"none", PosteriorCalibrationMethod::kNone},
      {"sbc", PosteriorCalibrationMethod::kSimulationBased},
  };
};

struct EvaluationSpec {
  bool limit = true;  ///< the information limit of every test sample
  std::optional<PosteriorSpec> posterior;
  PosteriorCalibrationMethod calibration = PosteriorCalibrationMethod::kNone;
  std::vector<BaselineSpec> baselines;
  std::vector<InverseMapSpec> maps;  ///< compared on the same samples, without refinement
};

template <class Fields>
void describe(Fields& f, EvaluationSpec& s) {
  f.optional("limit", s.limit, "the information limit of every test sample, at 2 p + 1 simulations each");
  f.optional("posterior", s.posterior, "exact posterior of some test samples, by simulation");
  f.optional("calibration", s.calibration,
             "sbc: simulation-based calibration of the posteriors of all test samples");
  f.optional("baselines", s.baselines, "other ways of inferring to compare with");
  f.optional("maps", s.maps, "maps to train and compare on the same samples, as inverse_map has them");
}

}  // namespace twinmap
