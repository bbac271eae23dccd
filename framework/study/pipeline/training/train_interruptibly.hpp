#pragma once

#include "framework/base/log/run_control.hpp"
#include "framework/estimation/run_tasks.hpp"

namespace twinmap {

/// What train() returns; throws Interrupted where it was stopped.
template <typename Train>
auto trainInterruptibly(const Train& train) {
  try {
    return train();
  } catch (const gp::Stopped&) {
    throw Interrupted("interrupted during training; the simulated samples are kept");
  }
}

}  // namespace twinmap
