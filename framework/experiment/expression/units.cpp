#include "framework/experiment/expression/units.hpp"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string_view>

#include "framework/base/files/installed_file.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};

/// UDUNITS keeps its parser's state and its last status in globals: one thread at a time. The cases of a
/// sweep read their experiments side by side.
std::mutex udunits;

/// A name that UDUNITS lacks, though everybody uses it.
void addDegree(ut_system* system) {
  const std::unique_ptr<ut_unit, FreeUnit> degree(ut_parse(system, "degree", UT_ASCII));
  ut_map_name_to_unit("deg", UT_ASCII, degree.get());
}

/// Torques as everybody writes them, with prefixes: mNm.
void addTorques(ut_system* system) {
  for (const auto& [symbol, unit] :
       {std::pair{"Nm", "N m"}, std::pair{"Ncm", "N cm"}, std::pair{"Nmm", "N mm"}}) {
    const std::unique_ptr<ut_unit, FreeUnit> torque(ut_parse(system, unit, UT_ASCII));
    ut_map_symbol_to_unit(symbol, UT_ASCII, torque.get());
  }
}

constexpr const char* kDatabase = "share/twinmap/units/udunits2.xml";

/// UDUNITS' own database of SI units, read once: the one that is installed with twinmap.
const ut_system& getUnitSystem() {
  static const std::unique_ptr<ut_system, FreeSystem> kSystem([] {
    ut_set_error_message_handler(ut_ignore);
    const std::filesystem::path database = findInstalled(kDatabase);
    ut_system* system = database.empty() ? nullptr : ut_read_xml(database.c_str());
    if (system != nullptr) {
      addDegree(system);
      addTorques(system);
    }
    return system;
  }());
  if (kSystem == nullptr) {
    throw std::runtime_error(std::string("units cannot be read: there is no ") + kDatabase + " in " +
                             findOwnFolder().string() +
                             " or a folder above it; install twinmap with its share/");
  }
  return *kSystem;
}

using UnitHandle = std::unique_ptr<ut_unit, FreeUnit>;

/// Call with `udunits` locked.
UnitHandle parse(const std::string& unit, const SourceLocation& where) {
  const std::string text = unit.empty() || unit == "-" ? "1" : unit;
  UnitHandle parsed(ut_parse(&getUnitSystem(), text.c_str(), UT_UTF8));
  if (parsed == nullptr) {
    throw ExperimentError(where, unit, "is not a unit; write units like N s/m, kg m^2, rad/s");
  }
  return parsed;
}

void addPower(Dimension& dimension, const ut_unit* base, int power) {
  const std::string symbol = ut_get_symbol(base, UT_ASCII);
  if (symbol != "rad" && power != 0) {
    dimension[symbol] = power;
  }
}

ut_status visitBase(const ut_unit* base, void* dimension) {
  addPower(*static_cast<Dimension*>(dimension), base, 1);
  return UT_SUCCESS;
}

ut_status visitProduct(const ut_unit*, int count, const ut_unit* const* bases, const int* powers,
                       void* dimension) {
  for (int i = 0; i < count; ++i) {
    addPower(*static_cast<Dimension*>(dimension), bases[i], powers[i]);
  }
  return UT_SUCCESS;
}

// Scaled, shifted, logarithmic and time-since units are not coherent.
ut_status visitScaled(const ut_unit*, double, const ut_unit*, double, void*) {
  return UT_BAD_ARG;
}
ut_status visitTimestamp(const ut_unit*, const ut_unit*, double, void*) {
  return UT_BAD_ARG;
}
ut_status visitLogarithm(const ut_unit*, double, const ut_unit*, void*) {
  return UT_BAD_ARG;
}

/// Of a unit with whole powers. Call with `udunits` locked. `unit`: as the file has it, for messages.
Dimension parseWholePowers(const std::string& text, const std::string& unit, const SourceLocation& where) {
  Dimension dimension;
  const UnitHandle parsed = parse(text, where);
  const ut_visitor visitor{visitBase, visitProduct, visitScaled, visitTimestamp, visitLogarithm};
  if (ut_accept_visitor(parsed.get(), &visitor, &dimension) != UT_SUCCESS) {
    throw ExperimentError(where, unit, "is not a coherent SI unit; give the value in m, kg, s, N, rad ...");
  }
  return dimension;
}

/// "m^1.5", a power that UDUNITS lacks.
struct BrokenPower {
  std::string base;
  double power = 0.0;
};

/// The first one of a unit, which becomes 1 there; the power is negative behind a "/".
std::optional<BrokenPower> takeBrokenPower(std::string& unit) {
  for (std::size_t hat = unit.find('^'); hat != std::string::npos; hat = unit.find('^', hat + 1)) {
    const std::size_t end = std::min(unit.find_first_not_of("-.0123456789", hat + 1), unit.size());
    std::size_t begin = hat;
    while (begin > 0 && std::isalpha(static_cast<unsigned char>(unit[begin - 1])) != 0) {
      --begin;
    }
    double power = 0.0;
    const std::string number = unit.substr(hat + 1, end - hat - 1);
    if (begin == hat || number.find('.') == std::string::npos || !parseLiteral(number, power)) {
      continue;
    }
    const std::size_t before = begin == 0 ? std::string::npos : unit.find_last_not_of(' ', begin - 1);
    const double sign = before != std::string::npos && unit[before] == '/' ? -1.0 : 1.0;
    const BrokenPower found{unit.substr(begin, hat - begin), sign * power};
    unit.replace(begin, end - begin, "1");
    return found;
  }
  return std::nullopt;
}

}  // namespace

Dimension parseUnit(const std::string& unit, const SourceLocation& where) {
  if (unit.empty() || unit == "-") {
    return {};
  }
  const std::lock_guard<std::mutex> guard(udunits);
  Dimension broken;
  std::string whole = unit;
  while (const std::optional<BrokenPower> found = takeBrokenPower(whole)) {
    for (const auto& [base, of_one] : parseWholePowers(found->base, unit, where)) {
      broken[base] += found->power * of_one;
    }
  }
  Dimension dimension = parseWholePowers(whole, unit, where);
  for (const auto& [base, power] : broken) {
    dimension[base] += power;
    if (dimension[base] == 0.0) {
      dimension.erase(base);
    }
  }
  return dimension;
}

std::string describeUnit(const Dimension& dimension) {
  for (const char* unit :
       {"1",       "m",   "kg",   "s",    "Hz",    "N", "N/m", "N s/m", "N m", "N m s/rad", "N/m^2", "N/m^3",
        "N s2/m2", "m/s", "m/s2", "kg m", "kg m2", "W", "V",   "ohm",   "H",   "V s/rad",   "N/A"}) {
    if (parseUnit(unit, {}) == dimension) {
      return unit;
    }
  }
  std::string text;
  for (const auto& [base, power] : dimension) {
    text += (text.empty() ? "" : " ") + base + (power == 1.0 ? "" : toText(power));
  }
  return text;
}

UnitConversion calcUnitConversion(const std::string& from, const std::string& to,
                                  const SourceLocation& where) {
  if (from == to) {
    return {};
  }
  const std::lock_guard<std::mutex> guard(udunits);
  const UnitHandle target = parse(to, where);
  UnitHandle source = parse(from, where);
  if (from == "g" && ut_are_convertible(source.get(), target.get()) == 0) {
    source = parse("standard_free_fall", where);  // of an acceleration
  }
  const std::unique_ptr<cv_converter, FreeConverter> converter(ut_get_converter(source.get(), target.get()));
  if (converter == nullptr) {
    throw ExperimentError(where, from, "does not convert to " + (to.empty() ? "a number" : to));
  }
  const double offset = cv_convert_double(converter.get(), 0.0);
  return {cv_convert_double(converter.get(), 1.0) - offset, offset};
}

bool isUnit(const std::string& text) {
  const bool has_letter =
      std::any_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  const std::lock_guard<std::mutex> guard(udunits);
  return has_letter && UnitHandle(ut_parse(&getUnitSystem(), text.c_str(), UT_UTF8)) != nullptr;
}

std::optional<double> findWholeTurn(const std::string& unit) {
  if (unit.empty() || unit == "1" || unit == "-" || unit == "%") {
    return std::nullopt;  // of the dimension of an angle, but no angle
  }
  // those of most outputs, for which an inference need not read the database, a quarter of its time
  static constexpr std::array<std::string_view, 14> kOthers{
      "m", "m/s", "m/s2", "m/s^2", "rad/s", "rad/s2", "rad/s^2", "N", "N m", "Nm", "V", "A", "s", "Hz"};
  if (std::find(kOthers.begin(), kOthers.end(), unit) != kOthers.end()) {
    return std::nullopt;
  }
  try {
    return calcUnitConversion("rad", unit, {}).apply(2.0 * std::acos(-1.0));
  } catch (const ExperimentError&) {
    return std::nullopt;
  }
}

}  // namespace twinmap
