#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

struct NormalPrior {
  double mean = 0.0, stddev = 1.0;
};

template <class Fields>
void describe(Fields& f, NormalPrior& s) {
  f.required("mean", s.mean, "in the parameter's unit");
  f.required("stddev", s.stddev, "in the parameter's unit", kPositive);
}

/// log(x / median) is normal with the standard deviation log(factor).
struct LognormalPrior {
  double median = 1.0, factor = 2.0;
};

template <class Fields>
void describe(Fields& f, LognormalPrior& s) {
  f.required("median", s.median, "in the parameter's unit", kPositive);
  f.required("factor", s.factor, "median / factor .. median * factor is the 68 % interval", kPositive);
  f.rule(s.factor > 1.0, "must give a factor above 1");
}

/// The logarithm is uniform within the bounds.
struct LogUniformPrior {};

template <class Fields>
void describe(Fields&, LogUniformPrior&) {}

/// Density s^(alpha - 1) (1 - s)^(beta - 1) with s from 0 at the lower to 1 at the upper bound.
struct BetaPrior {
  double alpha = 1.0, beta = 1.0;
};

template <class Fields>
void describe(Fields& f, BetaPrior& s) {
  f.required("alpha", s.alpha, "density s^(alpha - 1) (1 - s)^(beta - 1), s from bound to bound", kPositive);
  f.required("beta", s.beta, "", kPositive);
}

/// location + scale * t, t of Student's distribution.
struct StudentPrior {
  double location = 0.0, scale = 1.0, degrees = 4.0;
};

template <class Fields>
void describe(Fields& f, StudentPrior& s) {
  f.required("location", s.location, "in the parameter's unit");
  f.required("scale", s.scale, "in the parameter's unit", kPositive);
  f.optional("degrees", s.degrees, "of freedom; 4 allows for a data sheet that is wrong", kPositive);
}

/// What is known of a parameter before any measurement, cut off at its bounds.
struct PriorSpec {
  std::variant<std::monostate, NormalPrior, LognormalPrior, LogUniformPrior, BetaPrior, StudentPrior> kind;

  /// Whether it needs no bounds.
  bool hasRange() const {
    return std::holds_alternative<NormalPrior>(kind) || std::holds_alternative<LognormalPrior>(kind) ||
           std::holds_alternative<StudentPrior>(kind);
  }
  /// Whether it is of a logarithm, so that the bounds must be above 0.
  bool isOfLogarithm() const {
    return std::holds_alternative<LognormalPrior>(kind) || std::holds_alternative<LogUniformPrior>(kind);
  }
};

template <class Fields>
void describe(Fields& f, PriorSpec& s) {
  f.scalarIsKey();
  f.oneOf("must give one kind of prior:", choice<NormalPrior>("normal", s.kind, "mean and stddev"),
          choice<LognormalPrior>("lognormal", s.kind, "median and factor"),
          choice<LogUniformPrior>("log_uniform", s.kind, "uniform in the logarithm; bounds above 0"),
          choice<BetaPrior>("beta", s.kind, "alpha and beta, from bound to bound"),
          choice<StudentPrior>("student_t", s.kind, "heavy tails: location, scale, degrees"));
}

/// Priors of several parameters together.
struct CorrelatedPriors {
  std::vector<Name> names;
  double correlation = 0.0;
};

template <class Fields>
void describe(Fields& f, CorrelatedPriors& s) {
  f.required("names", s.names, "two parameters with normal or lognormal priors");
  f.required("correlation", s.correlation, "of them, or of their logarithms",
             NumberRule{-1.0, 1.0, false, "must be a number between -1 and 1"});
  f.rule(s.names.size() == 2, "must name two parameters");
  f.rule(s.correlation > -1.0 && s.correlation < 1.0, "must give a correlation between -1 and 1");
}

/// What an earlier inference left: a normal distribution of some parameters.
struct JointNormalPrior {
  std::vector<Name> names;
  std::vector<double> mean;        ///< in the parameters' units
  std::vector<double> covariance;  ///< row by row
};

template <class Fields>
void describe(Fields& f, JointNormalPrior& s) {
  f.required("names", s.names, "parameters without priors of their own");
  f.required("mean", s.mean, "of each, in its unit");
  f.required("covariance", s.covariance, "row by row");
  f.rule(s.mean.size() == s.names.size(), "must give as many means as names");
  f.rule(s.covariance.size() == s.names.size() * s.names.size(),
         "must give names x names numbers of covariance");
}

/// A file that states a JointNormalPrior, which replaces this when the experiment is loaded
/// (prior_files.hpp).
struct PriorFile {
  std::string file;
};

template <class Fields>
void describe(Fields& f, PriorFile& s) {
  f.value(s.file);
}

/// An entry of `priors`.
struct PriorGroupSpec {
  std::variant<std::monostate, CorrelatedPriors, JointNormalPrior, PriorFile> kind;
  SourceLocation where;
};

template <class Fields>
void describe(Fields& f, PriorGroupSpec& s) {
  f.location(s.where);
  f.oneOf("must give one kind of joint prior:",
          choice<CorrelatedPriors>("correlated", s.kind, "two parameters and their correlation"),
          choice<JointNormalPrior>("joint_normal", s.kind, "names, mean, covariance"),
          choice<PriorFile>("from", s.kind, "file that infer --json wrote"));
}

}  // namespace twinmap
