#include "framework/experiment/expression/expression.hpp"

#include <muParser.h>

#include <boost/math/constants/constants.hpp>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

bool hasAssignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') {
      continue;
    }
    const char before = i > 0 ? text[i - 1] : ' ';
    const char after = i + 1 < text.size() ? text[i + 1] : ' ';
    const bool comparison = after == '=' || before == '=' || before == '<' || before == '>' || before == '!';
    if (!comparison) {
      return true;
    }
  }
  return false;
}

[[noreturn]] void throwSyntaxError(const Expression& expression, const mu::Parser::exception_type& error) {
  throw ExperimentError(expression.where, expression.text, "is not a valid expression: " + error.GetMsg());
}

std::unique_ptr<mu::Parser> makeParser(const Expression& expression) {
  constexpr std::size_t kLongest = 4000;
  if (expression.text.size() > kLongest) {
    throw ExperimentError(expression.where, expression.text, "must have at most 4000 characters");
  }
  if (hasAssignment(expression.text)) {
    throw ExperimentError(expression.where, expression.text, "must not assign; write '==' to compare");
  }
  auto parser = std::make_unique<mu::Parser>();
  parser->DefineConst("pi", boost::math::constants::pi<double>());
  try {
    parser->SetExpr(expression.text);
  } catch (const mu::Parser::exception_type& error) {
    throwSyntaxError(expression, error);
  }
  return parser;
}

}  // namespace

int ExpressionScope::define(const std::string& name, double value) {
  if (!indices_.emplace(name, names_.size()).second) {
    throw std::invalid_argument("the name '" + name + "' is defined twice");
  }
  names_.push_back(name);
  values_.push_back(value);
  return static_cast<int>(names_.size()) - 1;
}

bool ExpressionScope::contains(const std::string& name) const {
  return indices_.count(name) > 0;
}

std::size_t ExpressionScope::find(const std::string& name, const Expression& user) const {
  const auto found = indices_.find(name);
  if (found == indices_.end()) {
    throw ExperimentError(user.where, user.text,
                          "uses the unknown name '" + name + "'" + suggestName(name, names_));
  }
  return found->second;
}

CompiledExpression ExpressionScope::compile(const Expression& expression) {
  double literal = 0.0;
  if (parseLiteral(expression.text, literal)) {
    return CompiledExpression(literal);
  }
  std::unique_ptr<mu::Parser> parser = makeParser(expression);
  const std::vector<std::string> used = getUsedNames(expression);
  try {
    for (const std::string& name : used) {
      parser->DefineVar(name, &values_[find(name, expression)]);
    }
    parser->Eval();  // builds the byte code, so that later evaluations only run it
  } catch (const mu::Parser::exception_type& error) {
    throwSyntaxError(expression, error);
  }
  return CompiledExpression(std::move(parser), expression.where);
}

CompiledExpression::CompiledExpression(double literal) : literal_(literal) {}
CompiledExpression::CompiledExpression(std::unique_ptr<mu::Parser> parser, SourceLocation where)
    : parser_(std::move(parser)), where_(std::move(where)) {}
CompiledExpression::CompiledExpression(CompiledExpression&&) noexcept = default;
CompiledExpression& CompiledExpression::operator=(CompiledExpression&&) noexcept = default;
CompiledExpression::~CompiledExpression() = default;

double CompiledExpression::calc() const {
  return parser_ ? parser_->Eval() : literal_;
}

std::vector<std::string> getUsedNames(const Expression& expression) {
  std::unique_ptr<mu::Parser> parser = makeParser(expression);
  std::vector<std::string> names;
  try {
    for (const auto& [name, address] : parser->GetUsedVar()) {
      names.push_back(name);
    }
  } catch (const mu::Parser::exception_type& error) {
    throwSyntaxError(expression, error);
  }
  return names;
}

bool isReservedName(const std::string& name) {
  return name == "t" || name == "pi";
}

}  // namespace twinmap
