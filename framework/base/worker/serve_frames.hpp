#pragma once

#include <functional>

#include "framework/base/worker/worker_process.hpp"

namespace twinmap {

/// The worker's side of WorkerProcess: answers requests until the other side is gone. Should that happen
/// while a request is worked on, a thread of its own ends this process and its group at once. `answer` may
/// set `last` to end after its answer. Never returns: nothing of what the model has loaded runs after it.
[[noreturn]] void serveFrames(const std::function<Frame(const Frame& request, bool& last)>& answer);

}  // namespace twinmap
