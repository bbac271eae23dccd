#include "kernels/program/evaluate.hpp"

#include <cassert>

#include "kernels/program/real.hpp"

namespace twinmap::program {

double evaluate(Operation operation, double a, double b, double c) {
  using namespace real;
  switch (operation) {
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kNegate:
      return -a;
    case Operation::kSqrt:
      return sqrt(a);
    case Operation::kAbs:
      return abs(a);
    case Operation::kSign:
      return sign(a);
    case Operation::kFloor:
      return floor(a);
    case Operation::kRint:
      return rint(a);
    case Operation::kSin:
      return sin(a);
    case Operation::kCos:
      return cos(a);
    case Operation::kTan:
      return tan(a);
    case Operation::kAsin:
      return asin(a);
    case Operation::kAcos:
      return acos(a);
    case Operation::kAtan:
      return atan(a);
    case Operation::kAtan2:
      return atan2(a, b);
    case Operation::kExp:
      return exp(a);
    case Operation::kLog:
      return log(a);
    case Operation::kLog2:
      return log2(a);
    case Operation::kLog10:
      return log10(a);
    case Operation::kPow:
      return pow(a, b);
    case Operation::kSinh:
      return sinh(a);
    case Operation::kCosh:
      return cosh(a);
    case Operation::kTanh:
      return tanh(a);
    case Operation::kAsinh:
      return asinh(a);
    case Operation::kAcosh:
      return acosh(a);
    case Operation::kAtanh:
      return atanh(a);
    case Operation::kMin:
      return min(a, b);
    case Operation::kMax:
      return max(a, b);
    case Operation::kLess:
      return less(a, b);
    case Operation::kLessOrEqual:
      return lessOrEqual(a, b);
    case Operation::kEqual:
      return equal(a, b);
    case Operation::kNotEqual:
      return notEqual(a, b);
    case Operation::kAnd:
      return both(a, b);
    case Operation::kOr:
      return either(a, b);
    case Operation::kSelect:
      return select(a, b, c);
    default:
      assert(false);
      return a;
  }
}

}  // namespace twinmap::program
