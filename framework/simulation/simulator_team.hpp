#pragma once

#include <functional>

#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Calls task(simulator, i) for i = 0 .. count - 1 on a team of threads (0: as many as OpenMP offers), each
/// with its own clone of `prototype`. Tasks start in order and must not depend on one another. An exception
/// of a task keeps further ones from starting and is thrown again. Throws std::invalid_argument for a
/// negative number of threads.
void runOnTeam(const Simulator& prototype, int count, int threads,
               const std::function<void(Simulator& simulator, int index)>& task);

/// Calls task(i, thread) for i = 0 .. count - 1 on so many threads (at least 1), in order, `thread` counted
/// from 0. An exception of a task keeps further ones from starting and is thrown again.
void runInTeam(int count, int threads, const std::function<void(int index, int thread)>& task);

}  // namespace twinmap
