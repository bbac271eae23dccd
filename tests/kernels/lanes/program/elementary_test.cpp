// The interpreter's own functions against the C library's in long double (64 bits of mantissa on x86).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "kernels/lanes/program/interpreter.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap::program {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
constexpr double kLargest = std::numeric_limits<double>::max();

/// In units of the last place that a double of the expected size has.
double calcErrorUlp(double value, long double expected) {
  const int exponent = std::max(std::ilogb(expected), -1022);
  return static_cast<double>(std::abs(value - expected) / std::ldexp(1.0L, exponent - 52));
}

using Function = std::function<long double(long double)>;

struct Case {
  const char* name;
  Operation operation;
  Function expected;
  double lowest, highest;
  double largest_error;  ///< as documented in exponential.hpp and trigonometric.hpp
};

const std::vector<Case>& getCases() {
  static const std::vector<Case> cases{
      {"sin", Operation::kSin, [](long double x) { return std::sin(x); }, -1e9, 1e9, 1.5},
      {"cos", Operation::kCos, [](long double x) { return std::cos(x); }, -1e9, 1e9, 1.5},
      {"tan", Operation::kTan, [](long double x) { return std::tan(x); }, -1e9, 1e9, 3.0},
      {"asin", Operation::kAsin, [](long double x) { return std::asin(x); }, -1.0, 1.0, 1.0},
      {"acos", Operation::kAcos, [](long double x) { return std::acos(x); }, -1.0, 1.0, 1.0},
      {"atan", Operation::kAtan, [](long double x) { return std::atan(x); }, -1e300, 1e300, 1.0},
      {"exp", Operation::kExp, [](long double x) { return std::exp(x); }, -745.0, 709.7, 1.0},
      {"log", Operation::kLog, [](long double x) { return std::log(x); }, 0.0, kLargest, 0.6},
      {"log2", Operation::kLog2, [](long double x) { return std::log2(x); }, 0.0, kLargest, 0.6},
      {"log10", Operation::kLog10, [](long double x) { return std::log10(x); }, 0.0, kLargest, 0.6},
      {"sinh", Operation::kSinh, [](long double x) { return std::sinh(x); }, -710.4, 710.4, 2.5},
      {"cosh", Operation::kCosh, [](long double x) { return std::cosh(x); }, -710.4, 710.4, 2.5},
      {"tanh", Operation::kTanh, [](long double x) { return std::tanh(x); }, -30.0, 30.0, 2.5},
      {"asinh", Operation::kAsinh, [](long double x) { return std::asinh(x); }, -kLargest, kLargest, 2.0},
      {"acosh", Operation::kAcosh, [](long double x) { return std::acosh(x); }, 1.0, kLargest, 3.0},
      {"atanh", Operation::kAtanh, [](long double x) { return std::atanh(x); }, -1.0, 1.0, 2.0},
      {"sqrt", Operation::kSqrt, [](long double x) { return std::sqrt(x); }, 0.0, kLargest, 0.5001},
  };
  return cases;
}

/// Random doubles between the limits: half of them spread evenly, half over the exponents, and some near 1.
class Arguments {
 public:
  explicit Arguments(const Case& test) : lowest_(test.lowest), highest_(test.highest) {}

  double next() {
    for (;;) {
      const double x = draw();
      if (x > lowest_ && x < highest_) {
        return x;
      }
    }
  }

 private:
  double draw() {
    const double u = std::uniform_real_distribution<>(0.0, 1.0)(engine_);
    switch (engine_() % 4) {
      case 0:
        return lowest_ + u * std::min(highest_ - lowest_, kLargest);
      case 1:
        return (u < 0.5 ? -1.0 : 1.0) * std::exp(20.0 * u - 10.0);
      case 2:
        return std::ldexp((engine_() % 2 == 0 ? 1.0 : -1.0) * (1.0 + u),
                          static_cast<int>(engine_() % 2098) - 1074);
      default:
        return (engine_() % 2 == 0 ? 1.0 : -1.0) * (1.0 + (u - 0.5) * 0.1);
    }
  }

  double lowest_, highest_;
  std::mt19937_64 engine_{7};
};

TEST(Elementary, ErrorsAreAsDocumented) {
  for (const Case& test : getCases()) {
    Arguments arguments(test);
    double largest = 0.0, where = 0.0;
    for (int i = 0; i < 200000; ++i) {
      const double x = arguments.next();
      const double error = calcErrorUlp(evaluate(test.operation, x), test.expected(x));
      if (!(error <= largest)) {
        largest = error;
        where = x;
      }
    }
    EXPECT_LE(largest, test.largest_error) << test.name << "(" << std::hexfloat << where << ")";
    RecordProperty(test.name, std::to_string(largest));
    std::printf("%-6s %.3f ulp\n", test.name, largest);
  }
}

TEST(Elementary, FunctionsOfTwoArgumentsToo) {
  std::mt19937_64 engine(3);
  std::normal_distribution<> normal(0.0, 3.0);
  double largest_pow = 0.0, largest_atan2 = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = std::exp(4.0 * normal(engine)), y = 8.0 * normal(engine);
    const long double power = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (power < kLargest) {
      largest_pow = std::max(largest_pow, calcErrorUlp(evaluate(Operation::kPow, x, y), power));
    }
    const double s = normal(engine) * x;
    const long double angle = std::atan2(static_cast<long double>(s), static_cast<long double>(y));
    largest_atan2 = std::max(largest_atan2, calcErrorUlp(evaluate(Operation::kAtan2, s, y), angle));
  }
  std::printf("pow %.3f, atan2 %.3f ulp\n", largest_pow, largest_atan2);
  EXPECT_LE(largest_pow, 1.5);
  EXPECT_LE(largest_atan2, 2.0);
}

TEST(Elementary, HugeArgumentsOfSineAndCosine) {
  for (const double x : {0x1p30, 0x1.8p31, 1e15, 1e22, 1e300, kLargest}) {
    EXPECT_EQ(evaluate(Operation::kSin, x), std::sin(x));
    EXPECT_EQ(evaluate(Operation::kCos, -x), std::cos(x));
  }
}

/// The same bits, any NaN being as good as another.
void expectSame(double value, double expected, const std::string& what) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(value)) << what << " gives " << value;
  } else {
    EXPECT_EQ(value, expected) << what;
    EXPECT_EQ(std::signbit(value), std::signbit(expected)) << what;
  }
}

TEST(Elementary, LimitsAreThoseOfTheCLibrary) {
  for (const Case& test : getCases()) {
    for (const double x :
         {0.0, -0.0, kInfinity, -kInfinity, kNaN, kSmallest, -kSmallest, 1.0, -1.0, kLargest}) {
      const double expected = static_cast<double>(test.expected(x));
      const double value = evaluate(test.operation, x);
      const bool exact =
          std::isnan(expected) || std::isinf(expected) || expected == 0.0 || std::abs(expected) == 1.0;
      if (exact) {
        expectSame(value, expected, std::string(test.name) + " of " + std::to_string(x));
      } else {
        EXPECT_LE(calcErrorUlp(value, test.expected(x)), test.largest_error) << test.name << " of " << x;
      }
    }
  }
}

TEST(Elementary, LimitsOfTwoArgumentsAreThoseOfTheCLibrary) {
  const std::vector<double> values{0.0, -0.0, 0.5,   -0.5,   1.0,    -1.0,      2.0,        -2.0,
                                   3.0, -3.0, 1e300, -1e300, 1e-300, kInfinity, -kInfinity, kNaN};
  for (const double x : values) {
    for (const double y : values) {
      const std::string arguments = " of " + std::to_string(x) + ", " + std::to_string(y);
      const double power = std::pow(x, y);
      if (std::isfinite(power)) {
        EXPECT_LE(calcErrorUlp(evaluate(Operation::kPow, x, y), power), 1.5) << "pow" << arguments;
        EXPECT_EQ(std::signbit(evaluate(Operation::kPow, x, y)), std::signbit(power)) << "pow" << arguments;
      } else {
        expectSame(evaluate(Operation::kPow, x, y), power, "pow" + arguments);
      }
      const double angle = std::atan2(x, y);
      const double value = evaluate(Operation::kAtan2, x, y);
      EXPECT_TRUE(std::isnan(angle)
                      ? std::isnan(value)
                      : calcErrorUlp(value, angle) <= 2.0 && std::signbit(value) == std::signbit(angle))
          << "atan2" << arguments << " is " << value << ", not " << angle;
      expectSame(evaluate(Operation::kMin, x, y), std::min(x, y), "min" + arguments);
      expectSame(evaluate(Operation::kMax, x, y), std::max(x, y), "max" + arguments);
      expectSame(evaluate(Operation::kLess, x, y), x < y ? 1.0 : 0.0, "less" + arguments);
      expectSame(evaluate(Operation::kEqual, x, y), x == y ? 1.0 : 0.0, "equal" + arguments);
      expectSame(evaluate(Operation::kNotEqual, x, y), x != y ? 1.0 : 0.0, "notEqual" + arguments);
      expectSame(evaluate(Operation::kSelect, x, y, 7.0), x != 0.0 ? y : 7.0, "select" + arguments);
    }
  }
}

TEST(Elementary, LogarithmsOfPowersAreIntegers) {
  for (int k = -1074; k < 1024; ++k) {
    EXPECT_EQ(evaluate(Operation::kLog2, std::ldexp(1.0, k)), k);
  }
  double power = 1.0;
  for (int k = 0; k <= 22; ++k, power *= 10.0) {
    EXPECT_EQ(evaluate(Operation::kLog10, power), k);
  }
}

/// Every function at many arguments, each lane another one, on every engine: the bits must be those of
/// evaluate().
TEST(Elementary, EveryEngineGivesTheSameBits) {
  ASSERT_GE(getEngines().size(), 2u);
  for (const Engine* engine : getEngines()) {
    for (const Case& test : getCases()) {
      Recorder recorder;
      Interpreter interpreter(compile(recorder, {record(test.operation, recorder.state(0))}, {1, 0, 0}),
                              *engine);
      Arguments arguments(test);
      for (int repetition = 0; repetition < 500; ++repetition) {
        for (int lane = 0; lane < engine->lanes; ++lane) {
          interpreter.updState(0)[lane] =
              lane == repetition % 16 ? 1e12 : arguments.next();  // of another range
        }
        interpreter.calcOutputs();
        for (int lane = 0; lane < engine->lanes; ++lane) {
          expectSame(interpreter.getOutput(0)[lane], evaluate(test.operation, interpreter.updState(0)[lane]),
                     test.name);
        }
      }
    }
  }
}

}  // namespace
}  // namespace twinmap::program
