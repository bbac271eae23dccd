// simulation_child ROOT SAMPLES THREADS CHUNK MICROSECONDS: simulates what the store at ROOT does not have,
// notes each simulated point as a line in ROOT/log, and writes all responses to ROOT/responses. SIGINT stops
// it with 130; errors go to stderr with 1. For interrupted_simulation_test.py to interrupt.
#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <thread>

#include "framework/sampling/simulate_missing.hpp"
#include "framework/store/atomic_file.hpp"
#include "tests/framework/sampling/counting_simulator.hpp"

namespace twinmap {
namespace {

std::atomic<bool> stop{false};

int run(const std::filesystem::path& root, int samples, const MissingOptions& options, int microseconds) {
  const int log = ::open((root / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  const CountingSimulator simulator([&](double p0) {
    const std::string line = std::to_string(static_cast<int>(p0)) + "\n";
    if (::write(log, line.data(), line.size()) < 0) {
      std::cerr << "the log cannot be written\n";
    }
    std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
  });
  TrajectoryStore store(root / "store", "counting", 2, simulator.getLayout().getRowCount());
  for (const SetAsideChunk& chunk : store.getSetAside()) {
    std::cout << "set aside: " << chunk.reason << "\n";
  }
  const StoredTrajectories result = simulateMissing(store, simulator, makeCountedPoints(samples), options);
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

int main(int, char** arguments) {
  std::signal(SIGINT, [](int) { twinmap::stop = true; });
  twinmap::MissingOptions options;
  options.threads = std::stoi(arguments[3]);
  options.chunk_samples = std::stoi(arguments[4]);
  options.stop = &twinmap::stop;
  try {
    return twinmap::run(arguments[1], std::stoi(arguments[2]), options, std::stoi(arguments[5]));
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
