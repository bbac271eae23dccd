#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

/// Each feature minus its mean, over its standard deviation.
struct ZScoreSpec {};

template <class Fields>
void describe(Fields&, ZScoreSpec&) {}

/// By stddev: each feature over the standard deviation of its noise. By covariance: combinations of features
/// whose noise is independent and of unit variance, for features whose noise is correlated.
enum class WhitenBy { kStddev, kCovariance };

template <>
struct EnumNames<WhitenBy> {
  static constexpr EnumName<WhitenBy> values[] = {{"stddev", WhitenBy::kStddev},
                                                  {"covariance", WhitenBy::kCovariance}};
};

struct WhitenSpec {
  WhitenBy by = WhitenBy::kStddev;
};

template <class Fields>
void describe(Fields& f, WhitenSpec& s) {
  f.optional("by", s.by, "each feature's own stddev, or the covariance, which makes noise independent too");
}

/// How many components a projection keeps; none: automatic.
struct ComponentCount {
  std::optional<int> number;
};

/// Principal components of the training features, those of largest variance. How many: as given, or enough to
/// explain a fraction of the variance, or by default those that stand above the noise of whitened features.
struct PrincipalComponentsSpec {
  ComponentCount components;
  std::optional<double> explained_variance;
};

template <class Fields>
void describe(Fields& f, PrincipalComponentsSpec& s) {
  f.optional("components", s.components, "how many, or automatic");
  f.optional("explained_variance", s.explained_variance, "as many as explain this fraction", kFraction);
  f.rule(!s.components.number || !s.explained_variance,
         "must give components or explained_variance, not both");
}

/// Directions of the training features that have most covariance with the parameters, those that predict
/// other simulations best by default.
struct PartialLeastSquaresSpec {
  ComponentCount components;
};

template <class Fields>
void describe(Fields& f, PartialLeastSquaresSpec& s) {
  f.optional("components", s.components, "how many, or automatic: by cross-validation");
}

/// The features that tell most about the parameters beyond what those selected before tell, by mutual
/// information.
struct MutualInformationSpec {
  int count = 0;
  int neighbours = 3;  ///< of the estimator
};

template <class Fields>
void describe(Fields& f, MutualInformationSpec& s) {
  f.required("count", s.count, "features to select", kCount);
  f.optional("neighbours", s.neighbours, "of the nearest-neighbour estimator", kThousand);
}

/// The features that determine the parameters best, to first order: greedy D-optimal selection.
struct FisherInformationSpec {
  int count = 0;
};

template <class Fields>
void describe(Fields& f, FisherInformationSpec& s) {
  f.required("count", s.count, "features to select", kCount);
}

/// The features of these names.
using FeatureNames = std::vector<Name>;

/// Some of the features.
using SelectSpec = std::variant<FeatureNames, MutualInformationSpec, FisherInformationSpec>;

template <class Fields>
void describe(Fields& f, SelectSpec& s) {
  f.oneOf(
      "must give one of", choice<FeatureNames>("features", s, "their names, such as y(0.05 s)"),
      choice<MutualInformationSpec>("mutual_information", s,
                                    "relevant to the parameters, without redundancy"),
      choice<FisherInformationSpec>("fisher_information", s, "greedy D-optimal, by simulated sensitivities"));
}

/// One step from features to the inputs of the inverse map, fitted on the training features.
struct TransformStepSpec {
  std::variant<ZScoreSpec, WhitenSpec, PrincipalComponentsSpec, PartialLeastSquaresSpec, SelectSpec> kind;
  SourceLocation where;
};

template <class Fields>
void describe(Fields& f, TransformStepSpec& s) {
  f.location(s.where);
  f.scalarIsKey();
  f.oneOf("must be one of",
          choice<ZScoreSpec>("z_score", s.kind, "each feature minus its mean, over its standard deviation"),
          choice<WhitenSpec>("whiten", s.kind, "features in units of their noise"),
          choice<PrincipalComponentsSpec>(
              "principal_components", s.kind,
              "projection on the directions of largest variance; by default those above the noise"),
          choice<PartialLeastSquaresSpec>("partial_least_squares", s.kind,
                                          "projection on the directions that predict the parameters best"),
          choice<SelectSpec>("select", s.kind, "keeps some of the features"));
}

}  // namespace twinmap
