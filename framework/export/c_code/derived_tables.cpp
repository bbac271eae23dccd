#include <fmt/core.h>

#include "framework/estimation/derived/derived_quantities.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/export/c_code/c_model_tables.hpp"

namespace twinmap {
namespace {

using program::Operation;

/// An operation in C99, with {0}, {1} and {2} for its operands; logical values are 0 and 1.
const char* getOperationInC(Operation operation) {
  switch (operation) {
    case Operation::kNegate:
      return "-{0}";
    case Operation::kSqrt:
      return "sqrt({0})";
    case Operation::kAbs:
      return "fabs({0})";
    case Operation::kSign:
      return "({0} > 0.0) - ({0} < 0.0)";
    case Operation::kFloor:
      return "floor({0})";
    case Operation::kRint:
      return "floor({0} + 0.5)";
    case Operation::kAdd:
      return "{0} + {1}";
    case Operation::kSubtract:
      return "{0} - {1}";
    case Operation::kMultiply:
      return "{0} * {1}";
    case Operation::kDivide:
      return "{0} / {1}";
    case Operation::kMin:
      return "{1} < {0} ? {1} : {0}";
    case Operation::kMax:
      return "{0} < {1} ? {1} : {0}";
    case Operation::kLess:
      return "{0} < {1}";
    case Operation::kLessOrEqual:
      return "{0} <= {1}";
    case Operation::kEqual:
      return "{0} == {1}";
    case Operation::kNotEqual:
      return "{0} != {1}";
    case Operation::kAnd:
      return "{0} != 0.0 && {1} != 0.0";
    case Operation::kOr:
      return "{0} != 0.0 || {1} != 0.0";
    case Operation::kSelect:
      return "{0} != 0.0 ? {1} : {2}";
    default:
      return nullptr;  // a function that C has by the same name
  }
}

/// Functions of <math.h> that are called alike.
std::string getFunctionInC(Operation operation) {
  switch (operation) {
#define TWINMAP_NAME_IN_C(kind, function, ...) \
  case Operation::k##kind:                     \
    return #function;
    TWINMAP_UNARY_FUNCTIONS(TWINMAP_NAME_IN_C)
    TWINMAP_BINARY_FUNCTIONS(TWINMAP_NAME_IN_C)
#undef TWINMAP_NAME_IN_C
    default:
      throw std::logic_error("an operation of an expression that C does not know");
  }
}

/// Names below `parameters` are parameters, the others computed before.
std::string makeOperation(const ExpressionTree::Node& node, std::size_t parameters) {
  const auto operand = [&](int k) {
    return "n" + std::to_string(node.operands[static_cast<std::size_t>(k)]);
  };
  if (node.operation == Operation::kLiteral) {
    return toC(node.literal);
  }
  if (node.operation == Operation::kParameter) {
    const auto place = static_cast<std::size_t>(node.operands[0]);
    return place < parameters ? fmt::format("parameters[{}]", place) : fmt::format("v{}", place);
  }
  if (const char* in_c = getOperationInC(node.operation)) {
    return fmt::format(fmt::runtime(in_c), operand(0), operand(1), operand(2));
  }
  const std::string arguments =
      operand(0) + (program::countOperands(node.operation) > 1 ? ", " + operand(1) : "");
  return getFunctionInC(node.operation) + "(" + arguments + ")";
}

/// A block that computes the name at a place from those before it.
std::string makeBlock(const BoundExpression& expression, std::size_t place, std::size_t parameters) {
  std::string text = fmt::format("  double v{};\n  {{\n", place);
  for (std::size_t i = 0; i < expression.nodes.size(); ++i) {
    text += fmt::format("    const double n{} = {};\n", i, makeOperation(expression.nodes[i], parameters));
  }
  return text +
         fmt::format("    v{} = n{};\n  }}\n  (void)v{};\n", place, expression.nodes.size() - 1, place);
}

}  // namespace

std::string makeDerivedExpressions(const ExportedModel& model) {
  const DerivedQuantities quantities(model.experiment);
  const auto parameters = static_cast<std::size_t>(quantities.countParameters());
  std::string text;
  const std::vector<BoundExpression> expressions = quantities.listExpressions();
  for (std::size_t i = 0; i < expressions.size(); ++i) {
    text += makeBlock(expressions[i], parameters + i, parameters);
  }
  const std::size_t first = parameters + expressions.size() - static_cast<std::size_t>(quantities.count());
  for (std::size_t k = 0; k < static_cast<std::size_t>(quantities.count()); ++k) {
    text +=
        fmt::format("  values[{}] = v{}; /* {} */\n", k, first + k, model.experiment.derived[k].name.text);
  }
  return text;
}

void addDerived(const ExportedModel& model, const std::string& prefix, CTables& tables) {
  constexpr double kDifference = 1e-6;  // of the widths, as DerivedQuantities takes it
  std::vector<std::string> names, units;
  for (const DerivedSpec& derived : model.experiment.derived) {
    names.push_back(derived.name.text);
    units.push_back(derived.unit);
  }
  const std::vector<ParameterSpec>& parameters = model.experiment.model.parameters;
  const Eigen::VectorXd widths = calcWidths(parameters), lower = calcLowerBounds(parameters);
  tables.addStrings(prefix + "_derived_names", names, "The derived quantities.");
  tables.addStrings(prefix + "_derived_units", units, "Their units.");
  tables.addWide("derived_lower", lower, "Lower bounds of the parameters.");
  tables.addWide("derived_upper", lower + widths, "Upper bounds of the parameters.");
  tables.addWide("derived_step", kDifference * widths, "Steps of differences.");
  tables.addNumber("derived_factor", model.getIntervalFactors().maxCoeff(),
                   "Half width of 95 % intervals in standard deviations: the largest of the parameters'.");
}

}  // namespace twinmap
