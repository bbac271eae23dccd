#pragma once

/// Every operation of recorded programs and of the expressions of experiment files, once. A new function is
/// one line here and its value on packets (packet.hpp, exponential.hpp, trigonometric.hpp): the parser,
/// records, literals, derivatives and the interpreter are made of these lines. They are macros, so that the
/// units compiled for other instruction sets take from them what they need and nothing else.
///
///   kind       Operation::k<kind>
///   function   its name, in C++ for symbols and numbers and, of a function of one operand, in expressions
///   rule       how record() writes down less than it is asked to: a function of simplify.cpp, or `keep`
///   value      of packets a, b and c (type P)
///   slope      of one operand: dy/da from the symbols a and y, the value
///   tangent    of more: dy from a, b and y and the tangents da, db and dc. A step (sign, floor, rint, a
///   comparison) has
///              the slope 0, abs at 0 as well; min, max and select that of the branch taken.

// X(kind, function, rule, value, slope)
#define TWINMAP_UNARY_OPERATORS(X) X(Negate, operator-, negate, -a, -1.0)
#define TWINMAP_UNARY_FUNCTIONS(X)                                                              \
  X(Sqrt, sqrt, keep, sqrt(a), 0.5 / y)                                                         \
  X(Abs, abs, even, abs(a), sign(a))                                                            \
  X(Sign, sign, keep, select<P>((a > 0.0) | (a < 0.0), copySign(broadcast<P>(1.0), a), a), 0.0) \
  X(Floor, floor, keep, floor(a), 0.0)                                                          \
  X(Rint, rint, keep, floor(a + 0.5), 0.0) /* to the nearest integer, halves upwards */         \
  X(Sin, sin, odd, sin(a), cos(a))                                                              \
  X(Cos, cos, even, cos(a), -sin(a))                                                            \
  X(Tan, tan, odd, tan(a), 1.0 + y * y)                                                         \
  X(Asin, asin, odd, asin(a), 1.0 / sqrt(1.0 - a * a))                                          \
  X(Acos, acos, keep, acos(a), -1.0 / sqrt(1.0 - a * a))                                        \
  X(Atan, atan, odd, atan(a), 1.0 / (1.0 + a * a))                                              \
  X(Exp, exp, keep, exp(a), y)                                                                  \
  X(Log, log, keep, log(a), 1.0 / a)                                                            \
  X(Log2, log2, keep, log2(a), (1.0 / 0.693147180559945309417) / a)    /* of ln 2 */            \
  X(Log10, log10, keep, log10(a), (1.0 / 2.302585092994045684018) / a) /* of ln 10 */           \
  X(Sinh, sinh, odd, sinh(a), cosh(a))                                                          \
  X(Cosh, cosh, even, cosh(a), sinh(a))                                                         \
  X(Tanh, tanh, odd, tanh(a), 1.0 - y * y)                                                      \
  X(Asinh, asinh, odd, asinh(a), 1.0 / sqrt(1.0 + a * a))                                       \
  X(Acosh, acosh, keep, acosh(a), 1.0 / (sqrt(a - 1.0) * sqrt(a + 1.0)))                        \
  X(Atanh, atanh, odd, atanh(a), 1.0 / (1.0 - a * a))

// X(kind, function, commutes, rule, value, tangent); a quotient's 1 / b is shared by all directions
#define TWINMAP_BINARY_OPERATORS(X)                                  \
  X(Add, operator+, true, add, a + b, da + db)                       \
  X(Subtract, operator-, false, subtract, a - b, da - db)            \
  X(Multiply, operator*, true, multiply, (a * b), (a * db + b * da)) \
  X(Divide, operator/, false, divide, a / b, (da - y * db) * (1.0 / b))
/* Logical values are 0 and 1; any number but 0 is true. min and max keep a first operand that is NaN. */
#define TWINMAP_BINARY_FUNCTIONS(X)                                                   \
  X(Atan2, atan2, false, keep, atan2(a, b), (b * da - a * db) / (a * a + b * b))      \
  X(Pow, pow, false, power, power(a, b),                                              \
    (b * pow(a, b - 1.0) * da + (db.isLiteral(0.0) ? Symbol(0.0) : y * log(a) * db))) \
  X(Min, min, false, keep, select<P>(b < a, b, a), select(less(b, a), db, da))        \
  X(Max, max, false, keep, select<P>(a < b, b, a), select(less(a, b), db, da))        \
  X(Less, less, false, keep, truth(a < b), 0.0)                                       \
  X(LessOrEqual, lessOrEqual, false, keep, truth(a <= b), 0.0)                        \
  X(Equal, equal, true, keep, truth(a == b), 0.0)                                     \
  X(NotEqual, notEqual, true, keep, truth(a != b), 0.0)                               \
  X(And, both, true, keep, truth((a != 0.0) & (b != 0.0)), 0.0)                       \
  X(Or, either, true, keep, truth((a != 0.0) | (b != 0.0)), 0.0)

// X(kind, function, rule, value, tangent): a != 0 ? b : c; both are computed, and what is not chosen may be
// anything
#define TWINMAP_TERNARY_FUNCTIONS(X) X(Select, select, choose, select<P>(a != 0.0, b, c), select(a, db, dc))

// X(kind, value): made by compile() alone, rounded once
#define TWINMAP_FUSED_OPERATIONS(X) \
  X(MultiplyAdd, fma(a, b, c))      \
  X(MultiplySubtract, fms(a, b, c)) \
  X(NegativeMultiplyAdd, fnma(a, b, c)) /* c - a * b */

#define TWINMAP_UNARY_OPERATIONS(X) TWINMAP_UNARY_OPERATORS(X) TWINMAP_UNARY_FUNCTIONS(X)
#define TWINMAP_BINARY_OPERATIONS(X) TWINMAP_BINARY_OPERATORS(X) TWINMAP_BINARY_FUNCTIONS(X)
