#include "framework/experiment/check/check_scope.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/tree/read_value.hpp"

namespace twinmap {
namespace {

/// How much a quantity of this dimension grows when every base unit is made smaller by a factor of its own.
double calcUnitChange(const Dimension& dimension) {
  double factor = 1.0;
  for (const auto& [base, power] : dimension) {
    const double change = base == "m" ? 1.7 : base == "kg" ? 2.3 : base == "s" ? 0.6 : 1.3;
    factor *= std::pow(change, power);
  }
  return factor;
}

/// Whether the expression has a number that may carry a unit of its own (7850 * area * length): one that is
/// not an exponent.
bool hasFreeNumber(const std::string& text) {
  const auto is_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_word = is_word(text[i]) && (i == 0 || !is_word(text[i - 1]));
    if (!begins_word || std::isalpha(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_') {
      continue;
    }
    const std::size_t before = text.substr(0, i).find_last_not_of(' ');
    if (before == std::string::npos || text[before] != '^') {
      return true;
    }
  }
  return false;
}

/// Whether both operands must be of one unit.
bool needsLikeOperands(program::Operation operation) {
  using program::Operation;
  switch (operation) {
    case Operation::kAdd:
    case Operation::kSubtract:
    case Operation::kMin:
    case Operation::kMax:
    case Operation::kLess:
    case Operation::kLessOrEqual:
    case Operation::kEqual:
    case Operation::kNotEqual:
      return true;
    default:
      return false;
  }
}

/// Of any curve at any argument.
constexpr double kSomeCurveValue = 0.41;

/// A part of an expression, in two sets of base units. A number may carry any unit.
struct ScaledTerm {
  double value, scaled;
  bool has_number;
};

bool areAlike(const ScaledTerm& a, const ScaledTerm& b) {
  constexpr double kTolerance = 1e-9;  // as in CheckScope::check
  const double first = a.scaled * b.value, second = b.scaled * a.value;
  return a.has_number || b.has_number || !std::isfinite(first) || !std::isfinite(second) ||
         std::abs(first - second) <= kTolerance * std::abs(first);
}

/// A number beside a quantity, in that one's unit.
ScaledTerm takeUnit(const ScaledTerm& term, const ScaledTerm& beside) {
  const double change = beside.scaled / beside.value;
  return term.has_number && !beside.has_number && std::isfinite(change)
             ? ScaledTerm{term.value, change * term.value, true}
             : term;
}

}  // namespace

void CheckScope::define(const Name& name, const std::optional<Dimension>& dimension, double reference_value) {
  std::optional<double> scaled;
  if (dimension) {
    scaled = calcUnitChange(*dimension) * reference_value;
  }
  add(name, {reference_value, scaled, dimension, {}});
}

void CheckScope::define(const Name& name, const Expression& expression) {
  Symbol symbol{check(expression, ""), {}, {}, getUsedNames(expression)};
  if (hasUnit(expression)) {
    symbol.scaled_value = calcScaled(expression, true);
  }
  add(name, symbol);
}

void CheckScope::defineDifference(const Name& name, const Expression& expression) {
  constexpr double kSomeDuration = 0.67;
  Symbol symbol{check(expression, "") / kSomeDuration, {}, {}, getUsedNames(expression)};
  if (hasUnit(expression)) {
    symbol.scaled_value = calcScaled(expression, true) / (calcUnitChange({{"s", 1}}) * kSomeDuration);
  }
  names_.push_back(name.text);
  symbols_.push_back(symbol);
}

void CheckScope::defineCurve(const Name& name, const std::optional<Dimension>& over,
                             const std::optional<Dimension>& dimension) {
  requireFree(name);
  const auto calc_change = [](const std::optional<Dimension>& of) {
    return of ? std::make_optional(calcUnitChange(*of)) : std::nullopt;
  };
  const std::optional<double> change = calc_change(dimension);
  curves_.push_back(
      {name.text, calc_change(over), change ? std::make_optional(kSomeCurveValue * *change) : std::nullopt});
}

void CheckScope::add(const Name& name, const Symbol& symbol) {
  requireFree(name);
  names_.push_back(name.text);
  symbols_.push_back(symbol);
}

void CheckScope::requireFree(const Name& name) const {
  requireIdentifier(name);
  if (isReservedName(name.text)) {
    throw ExperimentError(name.where, name.text, "is reserved in expressions; choose another name");
  }
  const bool is_curve = std::any_of(curves_.begin(), curves_.end(),
                                    [&](const Curve& curve) { return curve.name == name.text; });
  if (is_curve || std::find(names_.begin(), names_.end(), name.text) != names_.end()) {
    throw ExperimentError(
        name.where, name.text,
        "is taken; parameters, nuisance, inputs, constants, coordinates, speeds (<coordinate>_dot), states, "
        "expressions, curves and excitation signals share one name space");
  }
}

const CheckScope::Curve& CheckScope::findCurve(const ExpressionTree::Call& call,
                                               const Expression& expression) const {
  const auto found = std::find_if(curves_.begin(), curves_.end(),
                                  [&](const Curve& curve) { return curve.name == call.name; });
  if (found == curves_.end()) {
    calcScaled(expression, false);  // throws, with the place
  }
  return *found;
}

void CheckScope::defineTime() {
  constexpr double kSomeTime = 0.29;
  changes_ = true;
  names_.emplace_back("t");
  symbols_.push_back({kSomeTime, calcUnitChange({{"s", 1}}) * kSomeTime, Dimension{{"s", 1}}, {}});
}

std::optional<Dimension> CheckScope::readUnit(const std::string& unit, const SourceLocation& where) {
  SourceLocation unit_where = where;
  unit_where.key_path += ".unit";
  return unit.empty() ? std::nullopt : std::make_optional(parseUnit(unit, unit_where));
}

double CheckScope::check(const Expression& expression, const std::string& unit) const {
  double literal = 0.0;
  if (parseLiteral(expression.text, literal)) {
    return literal;
  }
  const double value = calcScaled(expression, false);
  const std::vector<std::string> used = getUsedNames(expression);
  requireLikeTerms(expression);
  if (!std::isfinite(value) && (used.empty() || !changes_)) {
    throw ExperimentError(expression.where, expression.text,
                          "is not a finite number at the centre of the bounds");
  }
  if (unit.empty() || used.empty() || !hasUnit(expression)) {
    return value;
  }
  const double change = calcUnitChange(parseUnit(unit, expression.where));
  const double scaled = calcScaled(expression, true);
  constexpr double kTolerance = 1e-9;  // far above rounding, far below any change of units
  const bool comparable = std::isfinite(value) && std::isfinite(scaled) && value != 0.0;
  if (comparable && std::abs(scaled - change * value) > kTolerance * std::abs(change * value)) {
    throw ExperimentError(expression.where, expression.text,
                          "does not come out in " + unit + " with the units stated: " + describeUnits(used));
  }
  return value;
}

void CheckScope::check(const Expression3& expressions, const std::string& unit) const {
  for (const Expression& expression : expressions) {
    check(expression, unit);
  }
}

bool CheckScope::hasUnit(const Expression& expression) const {
  const std::vector<ExpressionTree::Call> calls = parseExpression(expression).calls;
  const bool known = std::all_of(calls.begin(), calls.end(), [&](const ExpressionTree::Call& call) {
    return findCurve(call, expression).scaled_value.has_value();
  });
  return known && isUnitStated(getUsedNames(expression)) && !hasFreeNumber(expression.text);
}

void CheckScope::requireArgument(const Curve& curve, double value, double scaled,
                                 const Expression& expression) const {
  constexpr double kTolerance = 1e-9;  // as in check()
  const double expected = curve.over.value_or(1.0) * value;
  if (curve.over && std::isfinite(scaled) && std::isfinite(expected) &&
      std::abs(scaled - expected) > kTolerance * std::abs(expected)) {
    throw ExperimentError(expression.where, expression.text,
                          "calls the curve '" + curve.name +
                              "' with what is not in the unit of what it is a curve of ('over')");
  }
}

void CheckScope::requireLikeTerms(const Expression& expression) const {
  const ExpressionTree tree = parseExpression(expression);
  std::vector<ScaledTerm> terms;
  for (const ExpressionTree::Node& node : tree.nodes) {
    if (node.call >= 0) {
      const Curve& curve = findCurve(tree.calls[node.call], expression);
      const ScaledTerm& argument = terms[node.operands[0]];
      if (!argument.has_number) {
        requireArgument(curve, argument.value, argument.scaled, expression);
      }
      terms.push_back(
          {kSomeCurveValue, curve.scaled_value.value_or(kSomeCurveValue), !curve.scaled_value.has_value()});
    } else if (node.operation == program::Operation::kLiteral) {
      terms.push_back({node.literal, node.literal, true});
    } else if (node.operation == program::Operation::kParameter) {
      const auto found = std::find(names_.begin(), names_.end(), tree.names[node.operands[0]]);
      const Symbol& symbol = symbols_[found - names_.begin()];
      terms.push_back({symbol.reference_value, symbol.scaled_value.value_or(symbol.reference_value),
                       !symbol.scaled_value.has_value()});
    } else {
      const auto operand = [&](int k) {
        return node.operands[k] < 0 ? ScaledTerm{0.0, 0.0, false} : terms[node.operands[k]];
      };
      const bool alike = needsLikeOperands(node.operation);
      const ScaledTerm a = alike ? takeUnit(operand(0), operand(1)) : operand(0);
      const ScaledTerm b = alike ? takeUnit(operand(1), operand(0)) : operand(1);
      const ScaledTerm c = operand(2);
      if (alike && !areAlike(a, b)) {
        throw ExperimentError(expression.where, expression.text,
                              "adds or compares quantities of different units: " + describeUnits(tree.names));
      }
      // a number beside a quantity has its unit; an exponent has none
      const bool has_number = alike ? a.has_number && b.has_number
                              : node.operation == program::Operation::kPow
                                  ? a.has_number
                                  : a.has_number || b.has_number || c.has_number;
      terms.push_back({program::apply(node.operation, a.value, b.value, c.value),
                       program::apply(node.operation, a.scaled, b.scaled, c.scaled), has_number});
    }
  }
}

bool CheckScope::isUnitStated(const std::vector<std::string>& names) const {
  return std::all_of(names.begin(), names.end(), [this](const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    return found != names_.end() && symbols_[found - names_.begin()].scaled_value.has_value();
  });
}

/// "k in N/m, x in m"; a named expression by what it uses.
std::string CheckScope::describeUnits(const std::vector<std::string>& names) const {
  std::vector<std::string> open(names.rbegin(), names.rend()), listed;
  std::string text;
  while (!open.empty()) {
    const std::string name = open.back();
    open.pop_back();
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end() || std::find(listed.begin(), listed.end(), name) != listed.end()) {
      continue;
    }
    listed.push_back(name);
    const Symbol& symbol = symbols_[found - names_.begin()];
    if (symbol.dimension) {
      text += (text.empty() ? "" : ", ") + name + " in " + describeUnit(*symbol.dimension);
    }
    open.insert(open.end(), symbol.of.rbegin(), symbol.of.rend());
  }
  return text;
}

double CheckScope::calcScaled(const Expression& expression, bool scaled) const {
  NamedValues<double> values;
  for (const Curve& curve : curves_) {
    const double value = scaled ? curve.scaled_value.value_or(kSomeCurveValue) : kSomeCurveValue;
    values.defineFunction(curve.name, [value](std::vector<ExpressionTree::Node>& nodes, int) {
      nodes.push_back({program::Operation::kLiteral, value, {-1, -1, -1}});
      return static_cast<int>(nodes.size()) - 1;
    });
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const double value = symbols_[i].reference_value;
    values.define(names_[i], scaled ? symbols_[i].scaled_value.value_or(value) : value);
  }
  return values.calc(expression);
}

}  // namespace twinmap
