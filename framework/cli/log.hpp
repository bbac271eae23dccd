#pragma once

namespace twinmap::cli {

/// The log goes to stderr, in colour on a terminal unless NO_COLOR is set.
void setUpLog();

}  // namespace twinmap::cli
