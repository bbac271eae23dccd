// A store of many samples: what opening it costs, and reading a part.
//
//   store_bench FOLDER [samples] [rows] [asked]
//
// With asked = 0 it fills FOLDER up to so many samples, in chunks of 256 as runs write them (4 parameters,
// 200 rows); else it opens the store, finds which of all points are missing and loads `asked` of them, and
// prints times and the largest memory so far (VmHWM) as JSON, a line a step.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "framework/store/trajectory_store.hpp"

namespace {

using namespace twinmap;

constexpr Eigen::Index kParameters = 4, kChunk = 256;

/// Distinct, and the same in every run.
Eigen::MatrixXd makePoints(Eigen::Index first, Eigen::Index count) {
  return Eigen::MatrixXd::NullaryExpr(kParameters, count, [&](Eigen::Index row, Eigen::Index column) {
    return 1.0 / static_cast<double>(1 + (first + column) * kParameters + row);
  });
}

void fill(TrajectoryStore& store, Eigen::Index samples) {
  for (Eigen::Index first = store.getSampleCount(); first < samples; first += kChunk) {
    SampleBlock block;
    block.parameters = makePoints(first, std::min(kChunk, samples - first));
    block.responses = Eigen::MatrixXd::Random(store.getShape().rows, block.parameters.cols());
    block.statuses.assign(static_cast<std::size_t>(block.parameters.cols()), {true, ""});
    store.append(block);
  }
}

double readPeakMebibytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmHWM:") {
      double kibibytes = 0.0;
      status >> kibibytes;
      return kibibytes / 1024.0;
    }
  }
  return 0.0;
}

template <class Work>
void report(const std::string& name, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  work();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  std::cout << "{\"step\": \"" << name << "\", \"wall_s\": " << wall.count()
            << ", \"cpu_s\": " << double(std::clock() - cpu) / CLOCKS_PER_SEC
            << ", \"peak_mib\": " << readPeakMebibytes() << "}\n";
}

Eigen::Index getArgument(int argc, char** argv, int index, Eigen::Index otherwise) {
  return argc > index ? std::atol(argv[index]) : otherwise;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "store_bench FOLDER [samples] [rows] [asked]\n";
    return 2;
  }
  const Eigen::Index samples = getArgument(argc, argv, 2, 1000000);
  const Eigen::Index rows = getArgument(argc, argv, 3, 200);
  const Eigen::Index asked = getArgument(argc, argv, 4, 10000);
  const auto open = [&] {
    return std::make_unique<TrajectoryStore>(argv[1], "store_bench\n", kParameters, rows);
  };
  if (asked == 0) {
    fill(*open(), samples);
    return 0;
  }
  std::unique_ptr<TrajectoryStore> store;
  report("open", [&] { store = open(); });
  report("find", [&] { std::cerr << store->findMissing(makePoints(0, samples)).size() << " missing\n"; });
  report("load", [&] { store->load(makePoints(0, asked)); });
}
