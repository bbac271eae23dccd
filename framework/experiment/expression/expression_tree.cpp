#include "framework/experiment/expression/expression_tree.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cctype>
#include <charconv>
#include <map>

namespace twinmap {
namespace {

using program::Operation;

/// Operators between two operands, which they take from left to right; a token that begins another comes
/// after it.
struct Infix {
  const char* token;
  int precedence;
  Operation operation;
  bool swapped = false;  ///< a > b is b < a
};

constexpr Infix kInfixes[] = {{"||", 1, Operation::kOr},          {"&&", 2, Operation::kAnd},
                              {"<=", 3, Operation::kLessOrEqual}, {">=", 3, Operation::kLessOrEqual, true},
                              {"==", 3, Operation::kEqual},       {"!=", 3, Operation::kNotEqual},
                              {"<", 3, Operation::kLess},         {">", 3, Operation::kLess, true},
                              {"+", 4, Operation::kAdd},          {"-", 4, Operation::kSubtract},
                              {"*", 5, Operation::kMultiply},     {"/", 5, Operation::kDivide}};

const std::map<std::string, double> kConstants{{"pi", boost::math::constants::pi<double>()},
                                               {"_pi", boost::math::constants::pi<double>()},
                                               {"_e", boost::math::constants::e<double>()}};

const std::map<std::string, Operation> kUnaryFunctions{
#define TWINMAP_NAMED(kind, function, ...) {#function, Operation::k##kind},
    TWINMAP_UNARY_FUNCTIONS(TWINMAP_NAMED)
#undef TWINMAP_NAMED
        {"ln", Operation::kLog}};

/// Functions of any number of operands: the operation takes in one after the other.
const std::map<std::string, Operation> kFolds{
    {"sum", Operation::kAdd}, {"avg", Operation::kAdd}, {"min", Operation::kMin}, {"max", Operation::kMax}};

bool isNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Recursive descent; each member parses one rule of the grammar and returns its node.
class Parser {
 public:
  explicit Parser(const Expression& expression) : expression_(expression), text_(expression.text) {}

  ExpressionTree parse() {
    constexpr std::size_t kLongest = 4000;
    if (text_.size() > kLongest) {
      throw ExperimentError(expression_.where, text_, "must have at most 4000 characters");
    }
    parseChoice();
    if (peek() == '=') {
      throw ExperimentError(expression_.where, text_, "must not assign; write '==' to compare");
    }
    const std::size_t last = text_.find_last_not_of(" \t", at_ == 0 ? 0 : at_ - 1);
    const bool follows_digit = last < at_ && std::isdigit(static_cast<unsigned char>(text_[last])) != 0;
    if (follows_digit && at_ + 1 < text_.size() && text_[at_] == ',' &&
        std::isdigit(static_cast<unsigned char>(text_[at_ + 1])) != 0) {
      fail("a decimal point is '.', not ','");
    }
    if (peek() != '\0') {
      fail(follows_digit && isNameCharacter(text_[at_])
               ? "an operator is missing (a unit is not written here)"
               : "an operator is missing");
    }
    return std::move(tree_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw ExperimentError(expression_.where, text_,
                          fmt::format("is not a valid expression: {} at character {}", what, at_ + 1));
  }

  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
      ++at_;
    }
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool accept(const std::string& token) {
    peek();
    const bool found = text_.compare(at_, token.size(), token) == 0;
    at_ += found ? token.size() : 0;
    return found;
  }

  void expect(const std::string& token) {
    if (!accept(token)) {
      fail("'" + token + "' is missing");
    }
  }

  int add(Operation operation, int a, int b = -1, int c = -1) {
    tree_.nodes.push_back({operation, 0.0, {a, b, c}});
    return static_cast<int>(tree_.nodes.size()) - 1;
  }

  int addLiteral(double value) {
    const int node = add(Operation::kLiteral, -1);
    tree_.nodes.back().literal = value;
    return node;
  }

  int parseChoice() {
    const int condition = parseBinary(0);
    if (!accept("?")) {
      return condition;
    }
    const int yes = parseChoice();
    expect(":");
    const int no = parseChoice();
    return add(Operation::kSelect, condition, yes, no);
  }

  /// Operators that bind at least as strongly as `precedence`.
  int parseBinary(int precedence) {
    int left = parseSigned();
    while (const Infix* infix = acceptInfix(precedence)) {
      const int right = parseBinary(infix->precedence + 1);
      left = infix->swapped ? add(infix->operation, right, left) : add(infix->operation, left, right);
    }
    return left;
  }

  const Infix* acceptInfix(int precedence) {
    for (const Infix& infix : kInfixes) {
      if (infix.precedence >= precedence && accept(infix.token)) {
        return &infix;
      }
    }
    return nullptr;
  }

  int parseSigned() {
    constexpr int kDeepest = 1024;  // parsing nests as deeply, on the stack of any thread
    if (++depth_ > kDeepest) {
      fail("there are more than 1024 levels of nesting");
    }
    const int node = accept("-")   ? add(Operation::kNegate, parseSigned())
                     : accept("+") ? parseSigned()
                                   : parsePower();
    --depth_;
    return node;
  }

  int parsePower() {
    const int base = parsePrimary();
    return accept("^") ? add(Operation::kPow, base, parseSigned()) : base;
  }

  int parsePrimary() {
    const char next = peek();
    if (accept("(")) {
      const int inside = parseChoice();
      expect(")");
      return inside;
    }
    if (std::isdigit(static_cast<unsigned char>(next)) != 0 || next == '.') {
      return parseNumber();
    }
    if (!isNameCharacter(next)) {
      const bool as_python = next == '*' && at_ > 0 && text_[at_ - 1] == '*';
      fail(as_python ? "a power is written x^2, not x**2," : "a number, a name or '(' is missing");
    }
    return parseNamed();
  }

  int parseNumber() {
    double value = 0.0;
    const char* const end = text_.data() + text_.size();
    const auto [after, error] = std::from_chars(text_.data() + at_, end, value);
    if (error != std::errc() || (after != end && isNameCharacter(*after))) {
      fail("what is not a number begins with a digit (a unit is not written here)");
    }
    at_ = static_cast<std::size_t>(after - text_.data());
    return addLiteral(value);
  }

  int parseNamed() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && isNameCharacter(text_[at_])) {
      ++at_;
    }
    const std::string name = text_.substr(begin, at_ - begin);
    return peek() == '(' ? parseCall(name, begin) : addName(name);
  }

  int addName(const std::string& name) {
    if (const auto constant = kConstants.find(name); constant != kConstants.end()) {
      return addLiteral(constant->second);
    }
    const auto found = std::find(tree_.names.begin(), tree_.names.end(), name);
    const int place = static_cast<int>(found - tree_.names.begin());
    if (found == tree_.names.end()) {
      tree_.names.push_back(name);
    }
    return add(Operation::kParameter, place);
  }

  int parseCall(const std::string& name, std::size_t begin) {
    std::vector<int> operands;
    const std::size_t before = tree_.nodes.size();
    expect("(");
    const std::size_t inside = at_;
    do {
      operands.push_back(parseChoice());
    } while (accept(","));
    expect(")");
    const auto unary = kUnaryFunctions.find(name);
    if (unary != kUnaryFunctions.end() && operands.size() == 1) {
      return add(unary->second, operands[0]);
    }
    if (name == "atan2" && operands.size() == 2) {
      return add(Operation::kAtan2, operands[0], operands[1]);
    }
    if (name == "clamp" && operands.size() == 3) {
      return add(Operation::kMax, add(Operation::kMin, operands[0], operands[2]), operands[1]);
    }
    if (name == "difference" && operands.size() == 1) {  // a name, which those that sample give a value
      tree_.nodes.resize(before);
      return addName("difference(" + text_.substr(inside, at_ - 1 - inside) + ")");
    }
    if (const auto fold = kFolds.find(name); fold != kFolds.end()) {
      return addFold(name, fold->second, operands);
    }
    if (operands.size() == 1 && name != "atan2" && unary == kUnaryFunctions.end()) {
      tree_.calls.push_back({name, begin + 1});
      const int node = add(Operation::kLiteral, operands[0]);
      tree_.nodes.back().call = static_cast<int>(tree_.calls.size()) - 1;
      return node;
    }
    at_ = begin;
    fail(name == "atan2" ? fmt::format("'atan2' takes two operands, not {},", operands.size())
         : unary != kUnaryFunctions.end()
             ? fmt::format("'{}' takes one operand, not {},", name, operands.size())
             : fmt::format("there is no function '{}'", name));
  }

  int addFold(const std::string& name, Operation operation, const std::vector<int>& operands) {
    int value = operands[0];
    for (std::size_t i = 1; i < operands.size(); ++i) {
      value = add(operation, value, operands[i]);
    }
    if (name != "avg") {
      return value;
    }
    const int count = addLiteral(static_cast<double>(operands.size()));
    return add(Operation::kDivide, value, count);
  }

  const Expression& expression_;
  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  ExpressionTree tree_;
};

}  // namespace

ExpressionTree parseExpression(const Expression& expression) {
  return Parser(expression).parse();
}

std::vector<std::string> getUsedNames(const Expression& expression) {
  return parseExpression(expression).names;
}

std::vector<std::string> listFunctions() {
  std::vector<std::string> names{"atan2", "clamp"};
  for (const auto* functions : {&kUnaryFunctions, &kFolds}) {
    for (const auto& [name, operation] : *functions) {
      names.push_back(name);
    }
  }
  return names;
}

bool isReservedName(const std::string& name) {
  return name == "t" || name == "atan2" || name == "clamp" || name == "difference" ||
         kConstants.count(name) > 0 || kUnaryFunctions.count(name) > 0 || kFolds.count(name) > 0;
}

}  // namespace twinmap
