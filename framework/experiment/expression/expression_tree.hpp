#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace twinmap {

/// What a node of an expression does with its operands.
enum class Operation {
  kLiteral,
  kName,
  kNegate,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kChoose,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kAtan2,
  kSinh,
  kCosh,
  kTanh,
  kAsinh,
  kAcosh,
  kAtanh,
  kExp,
  kLog,
  kLog2,
  kLog10,
  kSqrt,
  kAbs,
  kSign,
  kRint,
  kMin,
  kMax
};

/// An expression in muParser's grammar as a sequence of operations, operands before what uses them, so that
/// it can be evaluated over any scalar (equations::calcExpression); an ExpressionScope evaluates numbers, by
/// muParser itself.
struct ExpressionTree {
  struct Node {
    Operation operation;
    double literal = 0.0;         ///< of kLiteral
    int name = -1;                ///< of kName: its place in `names`
    std::vector<int> operands{};  ///< nodes before this one
  };
  std::vector<Node> nodes;         ///< the last one is the value
  std::vector<std::string> names;  ///< in order of appearance; `pi` is a literal
};

/// What muParser may accept but this parser does not know: other number formats, several values.
class UnknownSyntax : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses an expression that an ExpressionScope compiles. Throws UnknownSyntax. Cost: linear in its length.
ExpressionTree parseExpression(const std::string& text);

}  // namespace twinmap
