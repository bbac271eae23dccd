#pragma once

#include <functional>

#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Threads that a parallel region would have here: in another one it has one.
int countThreads();
/// So many for what follows in this process; 0: as many as OpenMP offers.
void setThreads(int threads);

/// Calls task(simulator, i) for i = 0 .. count - 1 on a team of threads (0: as many as OpenMP offers), each
/// with its own clone of `prototype`. Tasks start in order and must not depend on one another. An exception
/// of a task keeps further ones from starting and is thrown again. Throws std::invalid_argument for a
/// negative number of threads.
void runOnTeam(const Simulator& prototype, int count, int threads,
               const std::function<void(Simulator& simulator, int index)>& task);

/// The same on the first `size` simulators of a team that was made before, a thread each.
void runOnTeam(const std::vector<std::unique_ptr<Simulator>>& team, int count, int size,
               const std::function<void(Simulator& simulator, int index)>& task);

}  // namespace twinmap
