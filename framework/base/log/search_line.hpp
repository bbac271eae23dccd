#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace twinmap {

/// Returns to the beginning of a terminal's line and empties it.
constexpr const char* kClearLine = "\r\x1b[K";

/// Says what a command is at (getSearchState) once it takes longer than two seconds: on a terminal in one
/// line that is renewed twice a second, elsewhere a line every five seconds. Has no clock of its own.
class SearchLine {
 public:
  using Write = std::function<void(const std::string& text)>;

  /// width: of the terminal, in columns; 0: not a terminal.
  SearchLine(std::size_t width, Write write) : width_(width), write_(std::move(write)) {}

  /// now: time since the command began, s. Writes where a line is due; more often than lines are wanted.
  void tick(double now);
  /// Another line was written: the next is due as if it had been this one's.
  void note(double now) { shown_ = now; }
  /// Removes the line from the terminal.
  void clear();

 private:
  const std::size_t width_;
  const Write write_;
  std::optional<double> shown_;
  bool is_on_terminal_ = false;
};

}  // namespace twinmap
