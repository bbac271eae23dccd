#pragma once

#include "kernels/lanes/program/operation.hpp"

namespace twinmap::program {

class Recorder;

/// A scalar whose arithmetic is written down instead of carried out: a value of a Recorder, or a literal.
/// Templates over the scalar work with double and Symbol alike if they use these operators, the functions of
/// operation_list.hpp (found by their argument) and those of kernels/lanes/program/real.hpp. Symbols of
/// different recorders must not meet (asserted).
class Symbol {
 public:
  Symbol(double literal = 0.0) : literal_(literal) {}
  Symbol(Recorder& recorder, int node) : recorder_(&recorder), node_(node) {}

  bool isLiteral() const { return recorder_ == nullptr; }
  bool isLiteral(double value) const { return isLiteral() && literal_ == value; }
  double getLiteral() const { return literal_; }       ///< of a literal
  Recorder* getRecorder() const { return recorder_; }  ///< null for a literal
  int getNode() const { return node_; }                ///< of any other

  Symbol& operator+=(Symbol other);
  Symbol& operator-=(Symbol other);
  Symbol& operator*=(Symbol other);
  Symbol& operator/=(Symbol other);

 private:
  Recorder* recorder_ = nullptr;
  int node_ = -1;
  double literal_ = 0.0;
};

/// Writes down `operation`, simplified: literals are folded, what was written down before is found again, and
/// x + 0, x * 1, x * 0, x - x vanish (x * 0 is 0 even for an x that will not be finite).
Symbol record(Operation operation, Symbol a, Symbol b = {}, Symbol c = {});

inline Symbol apply(Operation operation, Symbol a, Symbol b, Symbol c) {
  return record(operation, a, b, c);
}

#define TWINMAP_UNARY(kind, function, ...) \
  inline Symbol function(Symbol a) {       \
    return record(Operation::k##kind, a);  \
  }
#define TWINMAP_BINARY(kind, function, ...)    \
  inline Symbol function(Symbol a, Symbol b) { \
    return record(Operation::k##kind, a, b);   \
  }
#define TWINMAP_TERNARY(kind, function, ...)             \
  inline Symbol function(Symbol a, Symbol b, Symbol c) { \
    return record(Operation::k##kind, a, b, c);          \
  }
TWINMAP_UNARY_OPERATIONS(TWINMAP_UNARY)
TWINMAP_BINARY_OPERATIONS(TWINMAP_BINARY)
TWINMAP_TERNARY_FUNCTIONS(TWINMAP_TERNARY)
#undef TWINMAP_UNARY
#undef TWINMAP_BINARY
#undef TWINMAP_TERNARY

inline Symbol operator+(Symbol a) {
  return a;
}
inline Symbol& Symbol::operator+=(Symbol other) {
  return *this = *this + other;
}
inline Symbol& Symbol::operator-=(Symbol other) {
  return *this = *this - other;
}
inline Symbol& Symbol::operator*=(Symbol other) {
  return *this = *this * other;
}
inline Symbol& Symbol::operator/=(Symbol other) {
  return *this = *this / other;
}

}  // namespace twinmap::program
