#pragma once

#include <omp.h>

#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

/// Calls action(index, thread) for every index below `count`, in chunks dealt to `threads` threads as they
/// become free. With one thread it is a plain loop: a nested OpenMP region of one would allocate.
template <typename Action>
void parallelFor(int threads, Index count, Index chunk, const Action& action) {
  if (threads == 1) {
    for (Index i = 0; i < count; ++i) {
      action(i, 0);
    }
    return;
  }
#pragma omp parallel for num_threads(threads) schedule(dynamic, chunk)
  for (Index i = 0; i < count; ++i) {
    action(i, omp_get_thread_num());
  }
}

}  // namespace twinmap::linalg
