#pragma once

#include <map>
#include <optional>
#include <string>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

/// A physical dimension as powers of base units: {kg: 1, s: -2} for N/m. Radians have none. A contact's
/// stiffness has broken powers: N/m^1.5.
using Dimension = std::map<std::string, double>;

/// The dimension of a unit such as "N s/m", "kg m^2" or "m/s2" (UDUNITS-2 grammar; "" and "-" are 1),
/// which may have broken powers such as m^1.5. Throws ExperimentError for an unknown unit and for one that is
/// not coherent SI (mm, deg, kN): values are used as they stand, so N/mm would be a silent factor of 1000.
Dimension parseUnit(const std::string& unit, const SourceLocation& where);

/// A dimension as an engineer writes its unit, "N/m", for messages; one without such a name by powers of base
/// units, "kg m s-3". Radians are left out.
std::string describeUnit(const Dimension& dimension);

/// value [to] = factor * value [from] + offset.
struct UnitConversion {
  double factor = 1.0, offset = 0.0;

  double apply(double value) const { return factor * value + offset; }
};

/// From any unit that UDUNITS-2 knows (mm, deg, kN, degC ...; "" and "-" are 1) to another of its dimension;
/// Nm, Ncm and Nmm are torques, "g" is the acceleration of gravity where an acceleration is wanted.
/// Throws ExperimentError for an unknown unit and for one of another dimension.
UnitConversion calcUnitConversion(const std::string& from, const std::string& to,
                                  const SourceLocation& where);

/// Whether a text with a letter is a unit that UDUNITS-2 knows.
bool isUnit(const std::string& text);

/// A whole turn in a unit of angles ("rad", "deg", "mrad"); none of others, pure numbers among them.
std::optional<double> findWholeTurn(const std::string& unit);

}  // namespace twinmap
