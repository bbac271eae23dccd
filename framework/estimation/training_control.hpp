#pragma once

#include "kernels/gp/stop.hpp"

namespace twinmap {

/// How a training runs. A training that ends gives the same result for any of it.
struct TrainingControl {
  int threads = 1;
  gp::StopFlag stop = nullptr;  ///< once true, the training ends with gp::Stopped
};

}  // namespace twinmap
