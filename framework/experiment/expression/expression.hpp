#pragma once

#include <array>
#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "framework/base/text/source_location.hpp"

namespace mu {
class Parser;
}

namespace twinmap {

/// A number of the experiment file: a literal ("3.3") or an expression of named values ("m1 * L^2 / 12").
/// The grammar is muParser's: + - * / ^, comparisons, ?:, sin, cos, tan, exp, log, sqrt, abs, sign, min, max
/// ..., and the constant pi. Assignments are refused.
/// An empty text stands for "not given" where that is allowed.
struct Expression {
  std::string text = "0";
  SourceLocation where;
};

using Expression3 = std::array<Expression, 3>;

/// A reference to something declared elsewhere in the experiment file (a body, a coordinate, an output ...).
struct Name {
  std::string text;
  SourceLocation where;
};

class CompiledExpression;

/// Named values that expressions may use. Compiled expressions read the current values, so set the values,
/// then evaluate. Not copyable and not thread safe: one scope per thread.
class ExpressionScope {
 public:
  ExpressionScope() = default;
  ExpressionScope(const ExpressionScope&) = delete;
  ExpressionScope& operator=(const ExpressionScope&) = delete;

  /// Adds a name; returns its index. Throws std::invalid_argument if it exists already.
  int define(const std::string& name, double value = 0.0);
  bool contains(const std::string& name) const;
  const std::vector<std::string>& getNames() const { return names_; }
  double get(int index) const { return values_[index]; }
  double& upd(int index) { return values_[index]; }

  /// Parses `expression` against the names defined so far. Throws ExperimentError (with its location) for a
  /// syntax error, an unknown name (with the nearest known one) or an assignment.
  CompiledExpression compile(const Expression& expression);

 private:
  /// Index of a name that `user` uses.
  std::size_t find(const std::string& name, const Expression& user) const;

  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> indices_;  ///< in names_
  std::deque<double> values_;                             // addresses stay valid while names are added
};

/// An expression bound to a scope that must outlive it. A literal evaluates at no cost. Move-only.
class CompiledExpression {
 public:
  explicit CompiledExpression(double literal);
  CompiledExpression(std::unique_ptr<mu::Parser> parser, SourceLocation where);
  CompiledExpression(CompiledExpression&&) noexcept;
  CompiledExpression& operator=(CompiledExpression&&) noexcept;
  ~CompiledExpression();

  /// The value at the scope's current values; may be inf or NaN (division by zero ...).
  double calc() const;
  bool isLiteral() const { return parser_ == nullptr; }
  const SourceLocation& getLocation() const { return where_; }

 private:
  double literal_ = 0.0;
  std::unique_ptr<mu::Parser> parser_;
  SourceLocation where_;
};

/// The names that `expression` uses, in order of appearance. Throws ExperimentError on a syntax error.
std::vector<std::string> getUsedNames(const Expression& expression);

/// Names predefined in every expression, which therefore cannot name anything else: t (time in s) and pi.
bool isReservedName(const std::string& name);

}  // namespace twinmap
