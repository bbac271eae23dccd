#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/expression/expression_tree.hpp"
#include "framework/experiment/expression/units.hpp"

namespace twinmap {

/// The names that expressions may use, with their units where stated and a value at a reference point, to
/// check expressions before anything is simulated. A plain value: copy it to extend it.
class CheckScope {
 public:
  /// Adds a name. Throws ExperimentError if it is taken, reserved, or a function of the expressions.
  void define(const Name& name, const std::optional<Dimension>& dimension, double reference_value);

  /// Checks an expression and adds it as a name of its own, whose unit is what it comes out in; none where
  /// check() could not know.
  void define(const Name& name, const Expression& expression);

  /// The same for its rate of change, under a name that cannot be taken: difference(<expression>).
  void defineDifference(const Name& name, const Expression& expression);

  /// Lets expressions call a curve. `over`: the dimension of what it is a curve of, if that is stated. Throws
  /// ExperimentError for a name that is taken or reserved.
  void defineCurve(const Name& name, const std::optional<Dimension>& over,
                   const std::optional<Dimension>& dimension);

  /// Adds the time t in s, which only force laws know.
  void defineTime();

  /// The dimension of the unit stated for what is declared at `where`; none for "".
  static std::optional<Dimension> readUnit(const std::string& unit, const SourceLocation& where);

  /// Compiles `expression` and checks that it comes out in `unit`: a physical expression scales with the
  /// units of its names (dimensional homogeneity). Not checked where `unit` is "", where a name has no unit,
  /// and where a number may carry one (all but exponents). What is added or compared within must have one
  /// unit, whatever numbers stand beside. Returns the value at the reference point. Throws ExperimentError.
  double check(const Expression& expression, const std::string& unit) const;
  void check(const Expression3& expressions, const std::string& unit) const;

  const std::vector<std::string>& getNames() const { return names_; }

 private:
  struct Symbol {
    double reference_value;
    std::optional<double> scaled_value;  ///< in other base units; none where its unit is not known
    std::optional<Dimension> dimension;  ///< of the unit that was stated
    std::vector<std::string> of;         ///< names that a named expression uses
  };
  /// A function by the change of its argument and of its value in other base units, where they are known.
  struct Curve {
    std::string name;
    std::optional<double> over, scaled_value;
  };
  void requireFree(const Name& name) const;
  void add(const Name& name, const Symbol& symbol);
  const Curve& findCurve(const ExpressionTree::Call& call, const Expression& expression) const;
  void requireArgument(const Curve& curve, double value, double scaled, const Expression& expression) const;
  bool hasUnit(const Expression& expression) const;
  void requireLikeTerms(const Expression& expression) const;
  bool isUnitStated(const std::vector<std::string>& names) const;
  double calcScaled(const Expression& expression, bool scaled) const;
  std::string describeUnits(const std::vector<std::string>& names) const;

  std::vector<std::string> names_;
  std::vector<Symbol> symbols_;
  std::vector<Curve> curves_;
  bool changes_ = false;  ///< some of the names change in time
};

}  // namespace twinmap
