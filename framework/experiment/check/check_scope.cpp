#include "framework/experiment/check/check_scope.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/fields/read_value.hpp"

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

}  // namespace

void CheckScope::define(const Name& name, const std::optional<Dimension>& dimension, double reference_value) {
  requireIdentifier(name);
  if (isReservedName(name.text)) {
    throw ExperimentError(name.where, name.text, "is reserved in expressions; choose another name");
  }
  if (std::find(names_.begin(), names_.end(), name.text) != names_.end()) {
    throw ExperimentError(
        name.where, name.text,
        "is taken; parameters, nuisance, inputs, constants, coordinates, speeds (<coordinate>_dot) and "
        "excitation signals share one name space");
  }
  names_.push_back(name.text);
  symbols_.push_back({dimension, reference_value});
}

void CheckScope::defineTime() {
  constexpr double kSomeTime = 0.29;
  changes_ = true;
  names_.emplace_back("t");
  symbols_.push_back({Dimension{{"s", 1}}, kSomeTime});
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
  if (!std::isfinite(value) && (used.empty() || !changes_)) {
    throw ExperimentError(expression.where, expression.text,
                          "is not a finite number at the centre of the bounds");
  }
  if (unit.empty() || used.empty() || !isUnitStated(used) || hasFreeNumber(expression.text)) {
    return value;
  }
  const double change = calcUnitChange(parseUnit(unit, expression.where));
  const double scaled = calcScaled(expression, true);
  constexpr double kTolerance = 1e-9;  // far above rounding, far below any change of units
  const bool comparable = std::isfinite(value) && std::isfinite(scaled) && value != 0.0;
  if (comparable && std::abs(scaled - change * value) > kTolerance * std::abs(change * value)) {
    throw ExperimentError(expression.where, expression.text,
                          "does not come out in " + unit + " with the units stated for the names it uses");
  }
  return value;
}

void CheckScope::check(const Expression3& expressions, const std::string& unit) const {
  for (const Expression& expression : expressions) {
    check(expression, unit);
  }
}

bool CheckScope::isUnitStated(const std::vector<std::string>& names) const {
  return std::all_of(names.begin(), names.end(), [this](const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    return found != names_.end() && symbols_[found - names_.begin()].dimension.has_value();
  });
}

double CheckScope::calcScaled(const Expression& expression, bool scaled) const {
  NamedValues<double> values;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const double change = scaled && symbols_[i].dimension ? calcUnitChange(*symbols_[i].dimension) : 1.0;
    values.define(names_[i], change * symbols_[i].reference_value);
  }
  return values.calc(expression);
}

}  // namespace twinmap
