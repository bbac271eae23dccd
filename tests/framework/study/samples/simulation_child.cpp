// simulation_child ROOT SAMPLES THREADS CHUNK MICROSECONDS [WRITER WRITERS]: simulates what the store at ROOT
// does not have, notes each simulated point as a line in ROOT/log, and writes all responses to
// ROOT/responses. SIGINT stops it with 130; errors go to stderr with 1. As one of several writers it
// simulates every so manieth block of CHUNK samples alone and notes in ROOT/saved which are in the store. For
// interrupted_simulation_test.py and many_writers_test.py to interrupt.
#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <thread>

#include "framework/base/files/atomic_file.hpp"
#include "framework/study/samples/simulate_missing.hpp"
#include "tests/framework/study/samples/counting_simulator.hpp"

namespace twinmap {
namespace {

std::atomic<bool> stop{false};

/// Lines of numbers, each written whole.
class NumberLog {
 public:
  explicit NumberLog(const std::filesystem::path& file)
      : descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666)) {}
  NumberLog(const NumberLog&) = delete;
  NumberLog& operator=(const NumberLog&) = delete;
  ~NumberLog() { ::close(descriptor_); }

  void write(double number) const {
    const std::string line = std::to_string(static_cast<int>(number)) + "\n";
    if (::write(descriptor_, line.data(), line.size()) < 0) {
      std::cerr << "the log cannot be written\n";
    }
  }

 private:
  int descriptor_;
};

CountingSimulator makeSimulator(const NumberLog& log, int microseconds) {
  return CountingSimulator([&log, microseconds](double p0) {
    log.write(p0);
    std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
  });
}

struct Part {
  int writer, writers;
};

int runPart(const std::filesystem::path& root, int samples, const MissingOptions& options, int microseconds,
            const Part& part) {
  const NumberLog log(root / "log"), saved(root / "saved");
  const CountingSimulator simulator = makeSimulator(log, microseconds);
  TrajectoryStore store(root / "store", "counting", 2, simulator.getLayout().getRowCount());
  const Eigen::MatrixXd all = makeCountedPoints(samples);
  for (int first = part.writer * options.chunk_samples; first < samples;
       first += part.writers * options.chunk_samples) {
    const Eigen::MatrixXd points = all.middleCols(first, std::min(options.chunk_samples, samples - first));
    storeMissing(store, simulator, points, options);
    for (const auto& point : points.colwise()) {
      saved.write(point(0));
    }
  }
  return 0;
}

int run(const std::filesystem::path& root, int samples, const MissingOptions& options, int microseconds) {
  const NumberLog log(root / "log");
  const CountingSimulator simulator = makeSimulator(log, microseconds);
  TrajectoryStore store(root / "store", "counting", 2, simulator.getLayout().getRowCount());
  const StoredTrajectories result = simulateMissing(store, simulator, makeCountedPoints(samples), options);
  for (const SetAsideChunk& chunk : store.getSetAside()) {
    std::cout << "damaged: " << chunk.reason << "\n";
  }
  std::cout << "simulated " << result.counts.simulated << ", reused " << result.counts.reused << "\n";
  if (result.stopped) {
    return 130;
  }
  const Eigen::MatrixXd& responses = result.trajectories.responses;
  writeBytes(root / "responses", responses.data(), responses.size() * sizeof(double));
  return 0;
}

}  // namespace
}  // namespace twinmap

int main(int count, char** arguments) {
  std::signal(SIGINT, [](int) { twinmap::stop = true; });
  twinmap::MissingOptions options;
  options.threads = std::stoi(arguments[3]);
  options.chunk_samples = std::stoi(arguments[4]);
  options.stop = &twinmap::stop;
  try {
    if (count > 7) {
      return twinmap::runPart(arguments[1], std::stoi(arguments[2]), options, std::stoi(arguments[5]),
                              {std::stoi(arguments[6]), std::stoi(arguments[7])});
    }
    return twinmap::run(arguments[1], std::stoi(arguments[2]), options, std::stoi(arguments[5]));
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
