#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <vector>

#include "kernels/gp/stop.hpp"
#include "kernels/linalg/parallel.hpp"

namespace twinmap {

/// Runs action(index) for every index below `count` on `threads` threads; throws what the first of those that
/// failed threw, which no parallel region may leave.
template <typename Action>
void runTasks(int threads, std::size_t count, const Action& action) {
  std::vector<std::exception_ptr> errors(count);
  const int team = static_cast<int>(std::min(static_cast<std::size_t>(threads), count));
  linalg::parallelFor(std::max(team, 1), static_cast<Eigen::Index>(count), 1, [&](Eigen::Index i, int) {
    try {
      action(static_cast<std::size_t>(i));
    } catch (...) {
      errors[static_cast<std::size_t>(i)] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error != nullptr) {
      std::rethrow_exception(error);
    }
  }
}

/// Runs action(first, end) for all indices below `count`, some at a time, which may share buffers.
template <typename Action>
void runChunks(int threads, Eigen::Index count, const Action& action) {
  constexpr Eigen::Index kChunk = 16;
  runTasks(threads, static_cast<std::size_t>((count + kChunk - 1) / kChunk), [&](std::size_t chunk) {
    const Eigen::Index first = static_cast<Eigen::Index>(chunk) * kChunk;
    action(first, std::min(count, first + kChunk));
  });
}

/// How a training runs. A training that ends gives the same result for any of it.
struct TrainingControl {
  int threads = 1;
  gp::StopFlag stop = nullptr;  ///< once true, the training ends with gp::Stopped
};

}  // namespace twinmap
