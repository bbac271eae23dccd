#pragma once

#include "kernels/lanes/sample.hpp"

namespace twinmap::lanes {

/// Where samples come from and results go. An integrator calls its stream from its own thread; a stream
/// shared by several has to be safe for that.
class SampleStream {
 public:
  virtual ~SampleStream() = default;

  /// Fills in the next sample, or returns false: there is none left.
  virtual bool next(Sample& sample) = 0;
  virtual void finish(const Sample& sample, const Result& result) = 0;
};

}  // namespace twinmap::lanes
