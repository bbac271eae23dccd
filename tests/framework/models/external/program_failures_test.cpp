#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "framework/base/text/source_location.hpp"
#include "framework/models/external/program_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap::testing {
namespace {

ModelSpec makeFaulty(int batch = 1) {
  ModelSpec model;
  for (const char* name : {"mode", "a", "leak"}) {
    ParameterSpec parameter;
    parameter.name.text = name;
    parameter.bounds.lower = 0.0;
    parameter.bounds.upper = std::string(name) == "a" ? 4.0 : 0.0;
    model.parameters.push_back(parameter);
  }
  OutputSpec output;
  output.name.text = "x";
  output.variable = output.name;
  model.outputs = {output};
  model.simulation.duration = 1.0;
  ProgramSpec program;
  program.command = {"python3", "faulty.py"};
  program.working_folder = TWINMAP_SOURCE_DIR "/tests/framework/models/external/programs";
  program.timeout = 1.0;
  program.batch = batch;
  model.source = SourceSpec{};
  model.source->program = program;
  return model;
}

const Eigen::VectorXd kTimes = Eigen::Vector2d(0.5, 1.0);

/// One sample for each mode; a = 1 + its place.
Eigen::MatrixXd makePoints(const std::vector<int>& modes) {
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(modes.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    points(0, i) = modes[i];
    points(1, i) = 1.0 + static_cast<double>(i);
  }
  return points;
}

Trajectories generate(const ModelSpec& model, const std::vector<int>& modes, int threads = 1) {
  GeneratorOptions options;
  options.threads = threads;
  return generateSamples(ProgramSimulator(model, kTimes, 0), makePoints(modes), options);
}

std::string getReason(int mode) {
  return generate(makeFaulty(), {0, mode}).statuses[1].reason;
}

TEST(ProgramSimulator, NamesEveryFailureWithItsReason) {
  EXPECT_EQ(getReason(1), "the program crashed: Aborted; it said: the plant is on fire");
  EXPECT_EQ(getReason(2), "the program ended with exit code 3");
  EXPECT_EQ(getReason(3), "the program did not answer within 1 s");
  EXPECT_EQ(getReason(4), "output 'x' is not finite at t = 1 s");
  EXPECT_EQ(getReason(5), "output 'x' has 1 value instead of 2, one for each time");
  EXPECT_EQ(getReason(6), "the program's answer is not a JSON object: {no JSON");
  EXPECT_EQ(getReason(7), "no equilibrium");
}

TEST(ProgramSimulator, LetsNeighboursOfAFailureKnowNothingOfIt) {
  const std::vector<int> modes{0, 1, 0, 4, 0, 2, 7, 0, 6, 0, 5, 0};
  for (const int batch : {1, 4}) {
    for (const int threads : {1, 2}) {
      const Trajectories result = generate(makeFaulty(batch), modes, threads);
      for (std::size_t i = 0; i < modes.size(); ++i) {
        EXPECT_EQ(result.statuses[i].ok, modes[i] == 0) << "sample " << i << ", batch " << batch;
        if (modes[i] == 0) {
          EXPECT_EQ(result.responses(1, static_cast<Eigen::Index>(i)), 1.0 + static_cast<double>(i));
        } else {
          EXPECT_TRUE(result.responses.col(static_cast<Eigen::Index>(i)).array().isNaN().all());
        }
      }
    }
  }
}

TEST(ProgramSimulator, SaysThatOnlyAHangMayGoBetterAnotherTime) {
  EXPECT_TRUE(generate(makeFaulty(), {3}).statuses[0].machine_dependent);
  EXPECT_FALSE(generate(makeFaulty(), {1}).statuses[0].machine_dependent);
}

TEST(ProgramSimulator, RunsOnThoughTheProgramLeaksMoreThanItMayHave) {
  ModelSpec model = makeFaulty();
  model.source->program->memory = 0.6;  // GiB
  Eigen::MatrixXd points = makePoints(std::vector<int>(200, 0));
  points.row(2).setConstant(1e7);  // 2 GB in all
  const Trajectories result = generateSamples(ProgramSimulator(model, kTimes, 0), points, {});
  EXPECT_EQ(result.calcFailureCount(), 0);
}

TEST(ProgramSimulator, ThrowsWhereTheProgramCannotBeStarted) {
  ModelSpec model = makeFaulty();
  model.source->program->command = {"no-such-program-anywhere"};
  ProgramSimulator simulator(model, kTimes, 0);
  EXPECT_THROW(simulator.checkStart(), ExperimentError);
  model.source->program->command = {"true"};
  EXPECT_THROW(ProgramSimulator(model, kTimes, 0).checkStart(), ExperimentError);
}

std::string getStartError(const std::string& script) {
  ModelSpec model = makeFaulty();
  model.source->program->command = {"sh", "-c", script};
  model.source->program->start_timeout = 1.0;
  try {
    ProgramSimulator(model, kTimes, 0).checkStart();
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

TEST(ProgramSimulator, SaysAtTheStartWhatItWaitedForAndWhatItGot) {
  const std::string centre = "model.program: cannot simulate the centre of the bounds: ";
  EXPECT_EQ(getStartError("echo licence expired; exit 4"),
            "model.program: before its first answer, {\"twinmap\": 1}, the program ended with exit code 4; "
            "it said: "
            "licence expired");
  EXPECT_EQ(
      getStartError("sleep 100"),
      "model.program: before its first answer, {\"twinmap\": 1}, the program did not answer within 1 s");
  EXPECT_EQ(getStartError("echo '{\"twinmap\": 2}'; cat > /dev/null"),
            "model.program: the program's first answer must be {\"twinmap\": 1}, not {\"twinmap\": 2}");
  const std::string answering = "read first; echo '{\"twinmap\": 1}'; while read line; do echo ";
  EXPECT_EQ(getStartError(answering + "'{\"outputs\": {\"y\": [1], \"z\": [1]}}'; done"),
            centre + "the answer lacks output 'x'; it has 'y', 'z'");
  EXPECT_EQ(getStartError(answering + "'{\"outputs\": {\"x\": \"none\"}}'; done"),
            centre + "output 'x' is not a list of numbers: \"none\"");
}

TEST(ProgramSimulator, TakesANumberForAListOfOne) {
  ModelSpec model = makeFaulty();
  model.source->program->command = {"sh", "-c",
                                    "read first; echo '{\"twinmap\": 1}'; while read line; do echo "
                                    "'{\"outputs\": {\"x\": 0.25}}'; done"};
  Eigen::MatrixXd response(1, 1);
  SampleStatus status;
  ProgramSimulator(model, Eigen::VectorXd::Ones(1), 0).simulate(makePoints({0}), response, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  EXPECT_EQ(response(0, 0), 0.25);
}

TEST(ProgramSimulator, RefusesFeaturesOfModes) {
  EXPECT_THROW(ProgramSimulator(makeFaulty(), kTimes, 1), ExperimentError);
}

bool isAlive(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string id, name, state;
  file >> id >> name >> state;
  return !state.empty() && state != "Z" && state != "X";
}

TEST(ProgramSimulator, LeavesNoProcessBehindWhenItsOwnIsKilled) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {  // hangs in a shell's child, which knows of no parent
    ModelSpec model = makeFaulty();
    const std::string descriptor = std::to_string(ends[1]);
    model.source->program->timeout = 1000.0;
    model.source->program->command = {"sh", "-c",
                                      "sleep 1000 & echo $! > /proc/" + std::to_string(getpid()) + "/fd/" +
                                          descriptor + "; echo '{\"twinmap\": 1}'; wait"};
    ProgramSimulator(model, kTimes, 0).checkStart();
    _exit(0);
  }
  char text[32] = {};
  ASSERT_GT(read(ends[0], text, sizeof text - 1), 0);
  const pid_t sleeper = std::atoi(text);
  EXPECT_TRUE(isAlive(sleeper));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  constexpr int kTries = 200, kMicroseconds = 10000;
  for (int i = 0; i < kTries && isAlive(sleeper); ++i) {
    usleep(kMicroseconds);
  }
  EXPECT_FALSE(isAlive(sleeper));
}

}  // namespace
}  // namespace twinmap::testing
