#include "framework/models/fmu/package/unit_conversion.hpp"

namespace twinmap::fmi {
namespace {

/// Without radians, as parseUnit().
Dimension getDimension(const BaseUnit& unit) {
  Dimension dimension;
  for (std::size_t i = 0; i < unit.exponents.size(); ++i) {
    if (unit.exponents[i] != 0 && std::string(BaseUnit::kNames[i]) != "rad") {
      dimension[BaseUnit::kNames[i]] = unit.exponents[i];
    }
  }
  return dimension;
}

/// value in SI = factor * value + offset; none if nobody knows the unit.
std::optional<std::pair<Dimension, UnitConversion>> findUnit(const ModelDescription& description,
                                                             const std::string& unit) {
  const auto defined = description.units.find(unit);
  if (defined != description.units.end() && defined->second) {
    const BaseUnit& base = *defined->second;
    return std::make_pair(getDimension(base), UnitConversion{base.factor, base.offset});
  }
  return std::nullopt;
}

UnitConversion invert(const UnitConversion& conversion) {
  return {1.0 / conversion.factor, -conversion.offset / conversion.factor};
}

VariableUnits fromConversion(UnitConversion from_fmu, const Variable& variable) {
  if (variable.relative_quantity) {
    from_fmu.offset = 0.0;
  }
  return {invert(from_fmu), from_fmu};
}

bool isIdentity(const UnitConversion& conversion) {
  return conversion.factor == 1.0 && conversion.offset == 0.0;
}

/// By UDUNITS, which may not know the FMU's unit.
std::optional<UnitConversion> findByName(const std::string& fmu_unit, const std::string& unit) {
  try {
    calcUnitConversion(fmu_unit, "(" + fmu_unit + ") 1", {});  // throws only for a name that it does not know
  } catch (const ExperimentError&) {
    return std::nullopt;
  }
  return calcUnitConversion(fmu_unit, unit, {});
}

[[noreturn]] void refuseUnit(const Variable& variable, const std::string& unit, const SourceLocation& where) {
  const std::string own = unit.empty() ? "no unit" : unit;
  throw ExperimentError(where, own,
                        "does not fit the FMU's variable '" + variable.name + "', which is in " +
                            variable.unit + (unit.empty() ? "; state the coherent SI unit" : ""));
}

}  // namespace

VariableUnits calcVariableUnits(const ModelDescription& description, const Variable& variable,
                                const std::string& unit, const SourceLocation& where) {
  if (variable.unit.empty() || variable.unit == unit) {
    return {};
  }
  if (const auto defined = findUnit(description, variable.unit)) {
    if (unit.empty() ? !isIdentity(defined->second) : defined->first != parseUnit(unit, where)) {
      refuseUnit(variable, unit, where);
    }
    return fromConversion(defined->second, variable);
  }
  try {
    const std::optional<UnitConversion> known = findByName(variable.unit, unit);
    return known ? fromConversion(*known, variable) : VariableUnits{};
  } catch (const ExperimentError&) {
    refuseUnit(variable, unit, where);
  }
}

}  // namespace twinmap::fmi
