#pragma once

#include <array>
#include <string>
#include <vector>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

/// A number of the experiment file: a literal ("3.3") or an expression of named values ("m1 * L^2 / 12"), in
/// the grammar of expression_tree.hpp. An empty text stands for "not given" where that is allowed.
struct Expression {
  std::string text = "0";
  SourceLocation where;
};

using Expression3 = std::array<Expression, 3>;

/// A reference to something declared elsewhere in the experiment file (a body, a coordinate, an output ...).
struct Name {
  std::string text;
  SourceLocation where;
};

/// The names that `expression` uses, in order of appearance. Throws ExperimentError on a syntax error.
std::vector<std::string> getUsedNames(const Expression& expression);

/// Whether expressions give a name its meaning, so that it cannot name anything else: t (time in s), the
/// constants (pi, _pi, _e) and the functions.
bool isReservedName(const std::string& name);

}  // namespace twinmap
