#pragma once

namespace twinmap::cli {

/// The log goes to stderr, in colour on a terminal unless NO_COLOR is set.
void setUpLog();

/// From now on only warnings and errors go to stderr; a run's log file has all.
void showWarningsOnly();

}  // namespace twinmap::cli
