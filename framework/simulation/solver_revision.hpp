#pragma once

namespace twinmap {

/// Raise it with any change of the program that changes a bit of some response: what is stored from before is
/// then simulated anew.
inline constexpr int kSolverRevision = 2;

}  // namespace twinmap
