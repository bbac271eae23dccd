#include "framework/experiment/expression/expression_tree.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cctype>
#include <charconv>
#include <map>

namespace twinmap {
namespace {

const std::map<std::string, Operation> kFunctions{
    {"sin", Operation::kSin},     {"cos", Operation::kCos},     {"tan", Operation::kTan},
    {"asin", Operation::kAsin},   {"acos", Operation::kAcos},   {"atan", Operation::kAtan},
    {"sinh", Operation::kSinh},   {"cosh", Operation::kCosh},   {"tanh", Operation::kTanh},
    {"asinh", Operation::kAsinh}, {"acosh", Operation::kAcosh}, {"atanh", Operation::kAtanh},
    {"exp", Operation::kExp},     {"log", Operation::kLog},     {"ln", Operation::kLog},
    {"log2", Operation::kLog2},   {"log10", Operation::kLog10}, {"sqrt", Operation::kSqrt},
    {"abs", Operation::kAbs},     {"sign", Operation::kSign},   {"rint", Operation::kRint}};

/// Binary operators that take their operands from left to right, by increasing precedence; a token that
/// begins another comes after it.
const std::vector<std::vector<std::pair<std::string, Operation>>> kLevels{
    {{"||", Operation::kOr}},
    {{"&&", Operation::kAnd}},
    {{"<=", Operation::kLessEqual},
     {">=", Operation::kGreaterEqual},
     {"==", Operation::kEqual},
     {"!=", Operation::kNotEqual},
     {"<", Operation::kLess},
     {">", Operation::kGreater}},
    {{"+", Operation::kAdd}, {"-", Operation::kSubtract}},
    {{"*", Operation::kMultiply}, {"/", Operation::kDivide}}};

/// Nested deeper than this, an expression is refused: parsing one nests as deeply.
constexpr int kDeepest = 200;

/// muParser's own constant _pi, which has 13 digits.
constexpr double kMuparserPi = 3.141592653589;

bool isNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Recursive descent; each member parses one rule of the grammar and returns its node.
class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {}

  ExpressionTree parse() {
    parseChoice();
    if (peek() != '\0') {
      fail();
    }
    return std::move(tree_);
  }

 private:
  [[noreturn]] void fail() const {
    throw UnknownSyntax(fmt::format("'{}' is not understood at character {}", text_, at_ + 1));
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
      fail();
    }
  }

  int add(Operation operation, std::vector<int> operands) {
    tree_.nodes.push_back({operation, 0.0, -1, std::move(operands)});
    return static_cast<int>(tree_.nodes.size()) - 1;
  }

  int addLiteral(double value) {
    const int node = add(Operation::kLiteral, {});
    tree_.nodes.back().literal = value;
    return node;
  }

  int parseChoice() {
    const int condition = parseLevel(0);
    if (!accept("?")) {
      return condition;
    }
    const int yes = parseChoice();
    expect(":");
    const int no = parseChoice();
    return add(Operation::kChoose, {condition, yes, no});
  }

  int parseLevel(std::size_t level) {
    if (level == kLevels.size()) {
      return parseSigned();
    }
    int left = parseLevel(level + 1);
    while (const Operation* operation = acceptOperator(level)) {
      const int right = parseLevel(level + 1);
      left = add(*operation, {left, right});
    }
    return left;
  }

  const Operation* acceptOperator(std::size_t level) {
    for (const auto& [token, operation] : kLevels[level]) {
      if (accept(token)) {
        return &operation;
      }
    }
    return nullptr;
  }

  /// A sign binds weaker than a power: -x^2 = -(x^2).
  int parseSigned() {
    if (++depth_ > kDeepest) {
      fail();
    }
    const int node = parseSign();
    --depth_;
    return node;
  }

  int parseSign() {
    if (accept("-")) {
      return add(Operation::kNegate, {parseSigned()});
    }
    return accept("+") ? parseSigned() : parsePower();
  }

  int parsePower() {
    const int base = parsePrimary();
    if (!accept("^")) {
      return base;
    }
    const int exponent = parseSigned();  // from right to left: x^y^z = x^(y^z)
    return add(Operation::kPower, {base, exponent});
  }

  int parsePrimary() {
    const char next = peek();
    if (next == '(') {
      expect("(");
      const int inside = parseChoice();
      expect(")");
      return inside;
    }
    if (std::isdigit(static_cast<unsigned char>(next)) != 0 || next == '.') {
      return parseNumber();
    }
    return isNameCharacter(next) ? parseNamed() : (fail(), 0);
  }

  int parseNumber() {
    double value = 0.0;
    const char* const end = text_.data() + text_.size();
    const auto [after, error] = std::from_chars(text_.data() + at_, end, value);
    if (error != std::errc() || (after != end && isNameCharacter(*after))) {
      fail();
    }
    at_ = static_cast<std::size_t>(after - text_.data());
    return addLiteral(value);
  }

  int parseNamed() {
    std::size_t end = at_;
    while (end < text_.size() && isNameCharacter(text_[end])) {
      ++end;
    }
    const std::string name = text_.substr(at_, end - at_);
    at_ = end;
    return peek() == '(' ? parseCall(name) : addName(name);
  }

  int addName(const std::string& name) {
    if (name == "pi") {
      return addLiteral(boost::math::constants::pi<double>());
    }
    if (name == "_pi") {
      return addLiteral(kMuparserPi);
    }
    if (name == "_e") {
      return addLiteral(boost::math::constants::e<double>());
    }
    const auto found = std::find(tree_.names.begin(), tree_.names.end(), name);
    const int index = static_cast<int>(found - tree_.names.begin());
    if (found == tree_.names.end()) {
      tree_.names.push_back(name);
    }
    const int node = add(Operation::kName, {});
    tree_.nodes.back().name = index;
    return node;
  }

  int parseCall(const std::string& name) {
    std::vector<int> arguments;
    expect("(");
    do {
      arguments.push_back(parseChoice());
    } while (accept(","));
    expect(")");
    const auto found = kFunctions.find(name);
    if (found != kFunctions.end() && arguments.size() == 1) {
      return add(found->second, arguments);
    }
    if (name == "atan2" && arguments.size() == 2) {
      return add(Operation::kAtan2, arguments);
    }
    return fold(name, arguments);
  }

  /// A function of any number of arguments.
  int fold(const std::string& name, const std::vector<int>& arguments) {
    const std::map<std::string, Operation> folds{{"sum", Operation::kAdd},
                                                 {"avg", Operation::kAdd},
                                                 {"min", Operation::kMin},
                                                 {"max", Operation::kMax}};
    const auto found = folds.find(name);
    if (found == folds.end()) {
      fail();
    }
    int value = arguments[0];
    for (std::size_t i = 1; i < arguments.size(); ++i) {
      value = add(found->second, {value, arguments[i]});
    }
    if (name != "avg") {
      return value;
    }
    const int count = addLiteral(static_cast<double>(arguments.size()));
    return add(Operation::kDivide, {value, count});
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  ExpressionTree tree_;
};

}  // namespace

ExpressionTree parseExpression(const std::string& text) {
  return Parser(text).parse();
}

}  // namespace twinmap
