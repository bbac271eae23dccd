#pragma once

#include "kernels/lanes/program/operation.hpp"

namespace twinmap::program {

class Recorder;

/// A scalar whose arithmetic is written down instead of carried out: a value of a Recorder, or a literal.
/// Templates over the scalar work with double and Symbol alike if they use these operators, the functions
/// below (found by their argument) and those of kernels/lanes/program/real.hpp. Symbols of different
/// recorders must not meet (asserted).
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

inline Symbol operator+(Symbol a, Symbol b) {
  return record(Operation::kAdd, a, b);
}
inline Symbol operator-(Symbol a, Symbol b) {
  return record(Operation::kSubtract, a, b);
}
inline Symbol operator*(Symbol a, Symbol b) {
  return record(Operation::kMultiply, a, b);
}
inline Symbol operator/(Symbol a, Symbol b) {
  return record(Operation::kDivide, a, b);
}
inline Symbol operator-(Symbol a) {
  return record(Operation::kNegate, a);
}
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

inline Symbol sqrt(Symbol x) {
  return record(Operation::kSqrt, x);
}
inline Symbol abs(Symbol x) {
  return record(Operation::kAbs, x);
}
inline Symbol sign(Symbol x) {
  return record(Operation::kSign, x);
}
inline Symbol floor(Symbol x) {
  return record(Operation::kFloor, x);
}
inline Symbol rint(Symbol x) {
  return record(Operation::kRint, x);
}
inline Symbol sin(Symbol x) {
  return record(Operation::kSin, x);
}
inline Symbol cos(Symbol x) {
  return record(Operation::kCos, x);
}
inline Symbol tan(Symbol x) {
  return record(Operation::kTan, x);
}
inline Symbol asin(Symbol x) {
  return record(Operation::kAsin, x);
}
inline Symbol acos(Symbol x) {
  return record(Operation::kAcos, x);
}
inline Symbol atan(Symbol x) {
  return record(Operation::kAtan, x);
}
inline Symbol atan2(Symbol y, Symbol x) {
  return record(Operation::kAtan2, y, x);
}
inline Symbol exp(Symbol x) {
  return record(Operation::kExp, x);
}
inline Symbol log(Symbol x) {
  return record(Operation::kLog, x);
}
inline Symbol log2(Symbol x) {
  return record(Operation::kLog2, x);
}
inline Symbol log10(Symbol x) {
  return record(Operation::kLog10, x);
}
inline Symbol pow(Symbol x, Symbol y) {
  return record(Operation::kPow, x, y);
}
inline Symbol sinh(Symbol x) {
  return record(Operation::kSinh, x);
}
inline Symbol cosh(Symbol x) {
  return record(Operation::kCosh, x);
}
inline Symbol tanh(Symbol x) {
  return record(Operation::kTanh, x);
}
inline Symbol asinh(Symbol x) {
  return record(Operation::kAsinh, x);
}
inline Symbol acosh(Symbol x) {
  return record(Operation::kAcosh, x);
}
inline Symbol atanh(Symbol x) {
  return record(Operation::kAtanh, x);
}
inline Symbol min(Symbol a, Symbol b) {
  return record(Operation::kMin, a, b);
}
inline Symbol max(Symbol a, Symbol b) {
  return record(Operation::kMax, a, b);
}

/// 1 or 0.
inline Symbol less(Symbol a, Symbol b) {
  return record(Operation::kLess, a, b);
}
inline Symbol lessOrEqual(Symbol a, Symbol b) {
  return record(Operation::kLessOrEqual, a, b);
}
inline Symbol equal(Symbol a, Symbol b) {
  return record(Operation::kEqual, a, b);
}
inline Symbol notEqual(Symbol a, Symbol b) {
  return record(Operation::kNotEqual, a, b);
}
inline Symbol both(Symbol a, Symbol b) {
  return record(Operation::kAnd, a, b);
}
inline Symbol either(Symbol a, Symbol b) {
  return record(Operation::kOr, a, b);
}
/// condition != 0 ? a : b; both are computed, and what is not chosen may be anything, NaN too.
inline Symbol select(Symbol condition, Symbol a, Symbol b) {
  return record(Operation::kSelect, condition, a, b);
}

}  // namespace twinmap::program
