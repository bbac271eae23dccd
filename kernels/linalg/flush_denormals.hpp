#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace twinmap::linalg {

/// While it lives, this thread's subnormal numbers (below 2e-308) count as zero. Far-apart samples have such
/// covariances, and arithmetic on them takes a hundred cycles an operation: a factorisation ran 30 times
/// slower.
class FlushDenormals {
 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
#ifdef __SSE2__
  FlushDenormals() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | kFlushToZero | kDenormalsAreZero);
  }
  ~FlushDenormals() {
    _mm_setcsr(saved_);
  }

 private:
  static constexpr unsigned kFlushToZero = 0x8000;
  static constexpr unsigned kDenormalsAreZero = 0x0040;
  unsigned saved_;
#else
  FlushDenormals() {}
  ~FlushDenormals() {}
#endif
};

}  // namespace twinmap::linalg
