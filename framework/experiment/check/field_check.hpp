#pragma once

#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "framework/experiment/check/check_scope.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/system_spec.hpp"

namespace twinmap {

/// A coordinate of the system, its unit, and whether forces may act on it directly.
struct Coordinate {
  Name name;
  std::string unit;
  bool takes_forces;
};

/// Of all bodies' joints. Throws ExperimentError for a joint with another number of names than coordinates.
std::vector<Coordinate> collectCoordinates(const SystemSpec& system);

/// "" for "".
std::string makeRateUnit(const std::string& unit);

/// Checks the fields of descriptions (fields/fields.hpp) against the names declared before: expressions know
/// their names and come out in their units, names refer to something.
class FieldCheck {
 public:
  std::vector<std::string> bodies{"ground"};
  std::vector<Coordinate> coordinates;
  CheckScope constants;  ///< parameters and constants
  CheckScope dynamics;   ///< with coordinates, speeds, signals and time
  std::string own_unit;  ///< what kOwnUnit stands for

  template <class T, class... Rule>
  void required(const char*, const T& field, const char*, const Rule&... rule) {
    check(field, rule...);
  }
  template <class T, class... Rule>
  void optional(const char*, const T& field, const char*, const Rule&... rule) {
    check(field, rule...);
  }
  template <class T>
  void requiredMap(const char*, const std::vector<T>& fields, const char*) {
    for (const T& field : fields) {
      check(field);
      declare(field);
    }
  }
  /// States, and named expressions, which are checked where they are declared.
  void optionalMap(const char*, const std::vector<StateSpec>& states, const char*) {
    for (const StateSpec& state : states) {
      constants.check(state.initial, state.unit);
      dynamics.check(state.derivative, makeRateUnit(state.unit));
    }
  }
  void optionalMap(const char*, const std::vector<NamedExpression>&, const char*) {}
  /// Curves are checked where they are declared.
  void optionalMap(const char*, const std::vector<CurveSpec>&, const char*) {}
  /// checkSampled() does.
  void optionalMap(const char*, const std::vector<ControllerSpec>&, const char*) {}
  template <class... Choices>
  void oneOf(const char*, Choices... choices) {
    (std::apply([&](const auto&... rule) { check(std::as_const(choices.value), rule...); }, choices.rules),
     ...);
  }
  void rule(bool, const char*) const {}
  void scalarIsValueOf(const char*) const {}
  void location(const SourceLocation&) const {}

  /// All fields of a struct, which are read only.
  template <class T>
  void checkAll(const T& described) {
    describe(*this, const_cast<T&>(described));
  }

  /// Throws ExperimentError for a name that is not a coordinate.
  const Coordinate& find(const Name& name) const;

 private:
  void check(const Bounds&) {}
  void check(const std::vector<ShapeSpec>&) {}  // they have numbers alone
  void check(const Expression& expression, const Unit& unit) { check(expression, unit, on_angle_); }
  void check(const Expression& expression, const Unit& unit, bool on_angle);
  static std::string makeUnit(const Unit& unit, bool on_angle);
  void check(const SixOf<Expression>& expressions, const Unit& unit) {
    constexpr std::size_t kRotations = 3;
    for (std::size_t i = 0; i < expressions.size(); ++i) {
      check(expressions[i], unit, i < kRotations);
    }
  }
  void check(const Name& name, Reference reference);
  template <class T, std::size_t N>
  void check(const std::array<T, N>& fields, const Unit& unit) {
    for (const T& field : fields) {
      check(field, unit);
    }
  }
  /// A struct of a list refers to coordinates of its own, whatever those before it act on.
  template <class T, class... Rule>
  void check(const std::vector<T>& fields, const Rule&... rule) {
    for (const T& field : fields) {
      if constexpr (!std::is_same_v<T, Expression>) {
        on_angle_ = false;
      }
      check(field, rule...);
    }
  }
  void check(const std::vector<Expression>& fields, const ListRule&, const Unit& unit) {
    check(fields, unit);
  }
  template <class T, class... Rule>
  void check(const std::optional<T>& field, const Rule&... rule) {
    if (field) {
      check(*field, rule...);
    }
  }
  /// What has no unit and refers to nothing, or a struct.
  template <class T, class... Rule>
  void check(const T& field, const Rule&...) {
    if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string> && !std::is_same_v<T, Name>) {
      checkAll(field);
    }
  }

  void declare(const BodySpec& body) { bodies.push_back(body.name.text); }

  bool on_angle_ = false;  ///< whether the coordinate that was referred to last is an angle
};

}  // namespace twinmap
