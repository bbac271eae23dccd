#pragma once

#include <atomic>
#include <functional>

namespace twinmap::python {

/// Does `work` on a thread of its own while this one, which holds the interpreter's lock and lets go of it,
/// looks for signals and calls `tick` (with the lock) twenty times a second and once at the end. Where a
/// signal or `tick` throws (KeyboardInterrupt), `stop` is set, and thrown is that once the work has ended.
/// `work` must not touch Python; what it throws is thrown.
void runInterruptibly(const std::function<void()>& work, std::atomic<bool>& stop,
                      const std::function<void()>& tick = nullptr);

}  // namespace twinmap::python
