#include "kernels/lanes/program/interpreter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/lanes/program/recorder.hpp"
#include "kernels/lanes/program/schedule.hpp"
#include "tests/kernels/lanes/program/walk.hpp"

namespace twinmap::program {
namespace {

using testing::Inputs;
using testing::walk;

int countInstructions(const Segment& segment, Operation operation) {
  int count = 0;
  for (const Run& run : segment.runs) {
    count += run.operation == operation ? run.count : 0;
  }
  return count;
}

TEST(Compile, LeavesOutWhatNoOutputNeeds) {
  Recorder r;
  const Symbol x = r.state(0);
  sin(x) + exp(x);
  const Program program = compile(r, {x * x}, {1, 0, 0});
  EXPECT_EQ(program.evaluation.instructions.size(), 1u);
}

TEST(Compile, ComputesWhatParametersDetermineOnceASample) {
  Recorder r;
  const Symbol p = r.parameter(0), on = r.phaseInput(0), x = r.state(0);
  const Program program = compile(r, {sin(p) * x + exp(p) * on}, {1, 1, 1});
  EXPECT_EQ(program.parameter.instructions.size(), 2u);
  EXPECT_EQ(program.phase.instructions.size(), 1u);
  EXPECT_EQ(program.evaluation.instructions.size(), 1u);
  EXPECT_EQ(countInstructions(program.evaluation, Operation::kMultiplyAdd), 1);
}

TEST(Compile, JoinsProductsToSumsAndSineToCosine) {
  Recorder r;
  const Symbol x = r.state(0), y = r.state(1), z = r.state(2);
  const Program program = compile(r, {x * y + z, x * y - z, z - x * y, sin(x), cos(x), cos(y)}, {3, 0, 0});
  const Segment& segment = program.evaluation;
  EXPECT_EQ(segment.instructions.size(), 5u);
  EXPECT_EQ(countInstructions(segment, Operation::kMultiplyAdd), 1);
  EXPECT_EQ(countInstructions(segment, Operation::kMultiplySubtract), 1);
  EXPECT_EQ(countInstructions(segment, Operation::kNegativeMultiplyAdd), 1);
  EXPECT_EQ(countInstructions(segment, Operation::kSinCos), 1);
  EXPECT_EQ(countInstructions(segment, Operation::kCos), 1);
}

TEST(Compile, GroupsEqualOperations) {
  Recorder r;
  std::vector<Symbol> outputs;
  for (int i = 0; i < 20; ++i) {
    outputs.push_back(exp(sin(r.state(i)) / (2.0 + i)));
  }
  EXPECT_EQ(compile(r, outputs, {20, 0, 0}).evaluation.runs.size(), 3u);
}

TEST(Compile, UsesSlotsAgain) {
  Recorder r;
  Symbol x = r.state(0);
  for (int i = 0; i < 1000; ++i) {
    x = sin(x);
  }
  EXPECT_LE(compile(r, {x}, {1, 0, 0}).slot_count, 4);
}

TEST(Compile, OutputsMayBeInputsLiteralsAndTheSame) {
  Recorder r;
  const Symbol x = r.state(0), p = r.parameter(0);
  Interpreter interpreter(compile(r, {x, 3.0, p, p * 2.0, x, r.phaseInput(0), r.time()}, {1, 1, 1}));
  interpreter.updState(0)[1] = 5.0;
  interpreter.updParameter(0)[1] = 7.0;
  interpreter.updPhaseInput(0)[1] = 9.0;
  interpreter.updTime()[1] = 11.0;
  interpreter.calcParameters();
  interpreter.calcPhase();
  interpreter.calcOutputs();
  const double expected[] = {5.0, 3.0, 7.0, 14.0, 5.0, 9.0, 11.0};
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(interpreter.getOutput(i)[1], expected[i]);
  }
}

constexpr InputCounts kCounts{3, 3, 2};

/// A graph of random operations whose values stay of order one.
std::vector<Symbol> recordAtRandom(Recorder& r, int size, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<Symbol> values{r.time(), 0.7, -1.3};
  for (int i = 0; i < 3; ++i) {
    values.push_back(r.state(i));
    values.push_back(r.parameter(i));
    values.push_back(r.phaseInput(i % 2));
  }
  const auto pick = [&] { return values[engine() % values.size()]; };
  for (int i = 0; i < size; ++i) {
    const Symbol a = pick(), b = pick(), c = pick();
    const Symbol choices[] = {a * b - c,
                              a + b * c,
                              c - a * b,
                              sin(a),
                              cos(a),
                              a - b,
                              0.5 * (a + b),
                              a / (2.0 + b * b),
                              sqrt(1.0 + a * a),
                              tanh(a),
                              select(less(a, b), b, c),
                              atan2(a, b),
                              min(a, b),
                              exp(-abs(a)),
                              -a};
    values.push_back(tanh(choices[engine() % 15]));
    values.push_back(choices[engine() % 15] * 0.3);
  }
  return {values.end() - 20, values.end()};
}

Inputs drawInputs(std::mt19937& engine) {
  std::normal_distribution<> normal;
  const auto draw = [&](int count) {
    std::vector<double> values(count);
    for (double& value : values) {
      value = normal(engine);
    }
    return values;
  };
  return {normal(engine), draw(3), draw(3), draw(2)};
}

void setLane(Interpreter& interpreter, int lane, const Inputs& inputs) {
  interpreter.updTime()[lane] = inputs.time;
  for (int i = 0; i < 3; ++i) {
    interpreter.updState(i)[lane] = inputs.states[i];
    interpreter.updParameter(i)[lane] = inputs.parameters[i];
  }
  for (int i = 0; i < 2; ++i) {
    interpreter.updPhaseInput(i)[lane] = inputs.phase_inputs[i];
  }
}

TEST(Interpreter, ComputesWhatTheGraphSaysOnEveryEngineWithTheSameBits) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Recorder recorder;
    const std::vector<Symbol> outputs = recordAtRandom(recorder, 20 * seed, seed);
    const Program program = compile(recorder, outputs, kCounts);
    std::vector<Inputs> inputs;
    std::mt19937 random(seed);
    for (int lane = 0; lane < 16; ++lane) {
      inputs.push_back(drawInputs(random));
    }
    std::vector<std::vector<double>> first(16);
    for (const Engine* engine : getEngines()) {
      Interpreter interpreter(program, *engine);
      for (int begin = 0; begin < 16; begin += engine->lanes) {
        for (int lane = 0; lane < engine->lanes; ++lane) {
          setLane(interpreter, lane, inputs[begin + lane]);
        }
        interpreter.calcParameters();
        interpreter.calcPhase();
        interpreter.calcOutputs();
        interpreter.calcOutputs();  // nothing that it reads has been overwritten
        for (int lane = 0; lane < engine->lanes; ++lane) {
          std::vector<double> values;
          for (std::size_t i = 0; i < outputs.size(); ++i) {
            values.push_back(interpreter.getOutput(static_cast<int>(i))[lane]);
          }
          std::vector<double>& reference = first[begin + lane];
          reference = reference.empty() ? values : reference;
          EXPECT_EQ(values, reference) << "seed " << seed << ", " << engine->lanes << " lanes";
        }
      }
    }
    for (int lane = 0; lane < 16; ++lane) {
      const std::vector<double> expected = walk(recorder, outputs, inputs[lane]);
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        EXPECT_NEAR(first[lane][i], expected[i], 1e-11) << "seed " << seed;  // rounding once instead of twice
      }
    }
  }
}

TEST(Interpreter, OneLanesNanStaysThere) {
  Recorder recorder;
  const Program program = compile(recorder, recordAtRandom(recorder, 200, 3), kCounts);
  for (const Engine* engine : getEngines()) {
    std::mt19937 random(1);
    Interpreter clean(program, *engine), disturbed(program, *engine);
    for (int lane = 0; lane < engine->lanes; ++lane) {
      const Inputs inputs = drawInputs(random);
      setLane(clean, lane, inputs);
      setLane(disturbed, lane, inputs);
    }
    disturbed.updState(0)[2] = std::nan("");
    disturbed.updParameter(1)[2] = INFINITY;
    for (Interpreter* interpreter : {&clean, &disturbed}) {
      interpreter->calcParameters();
      interpreter->calcPhase();
      interpreter->calcOutputs();
    }
    for (int lane = 0; lane < engine->lanes; ++lane) {
      for (int i = 0; lane != 2 && i < 20; ++i) {
        EXPECT_EQ(clean.getOutput(i)[lane], disturbed.getOutput(i)[lane]);
      }
    }
  }
}

/// The cosine is used long before the sine of the same argument, which is made with it.
TEST(Interpreter, ProgramsOfSeveralPiecesAreWhatWasWrittenDown) {
  Recorder r;
  const Symbol x = r.state(0), p = r.parameter(0);
  Symbol sum = cos(x) * p, product = 1.0;
  for (int i = 0; i < static_cast<int>(kLargestPiece); ++i) {
    const Symbol weight = 1.0 + 1e-4 * i;
    sum += exp(-weight * x) * cos(weight * p * x);
    product *= 1.0 + 1e-4 * cos(sum);
  }
  const std::vector<Symbol> outputs{sum, product, sin(x) * sum};
  const Program program = compile(r, outputs, {1, 1, 0});
  ASSERT_GT(program.evaluation.instructions.size(), 2 * kLargestPiece);
  const std::vector<double> expected = walk(r, outputs, {0.0, {0.7}, {1.3}, {}});
  for (const Engine* engine : getEngines()) {
    Interpreter interpreter(program, *engine);
    interpreter.updState(0)[1] = 0.7;
    interpreter.updParameter(0)[1] = 1.3;
    interpreter.calcParameters();
    interpreter.calcPhase();
    interpreter.calcOutputs();
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(interpreter.getOutput(i)[1] / expected[i], 1.0, 1e-9);
    }
  }
}

TEST(Interpreter, FewLanesReachMoreSlots) {
  Recorder r;
  const Program program = compile(r, {r.state(29999) * 2.0}, {30000, 0, 0});
  Interpreter interpreter(program, kEngine4);
  interpreter.updState(29999)[3] = 4.0;
  interpreter.calcOutputs();
  EXPECT_EQ(interpreter.getOutput(0)[3], 8.0);
  EXPECT_THROW(Interpreter(program, kEngine16), std::length_error);
}

}  // namespace
}  // namespace twinmap::program
