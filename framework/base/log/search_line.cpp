#include "framework/base/log/search_line.hpp"

#include "framework/base/log/search_stage.hpp"

namespace twinmap {

void SearchLine::tick(double now) {
  constexpr double kPatience = 2.0, kTerminal = 0.5, kElsewhere = 5.0;  // s
  const double interval = !shown_ ? kPatience : width_ > 0 ? kTerminal : kElsewhere;
  if (now - shown_.value_or(0.0) < interval) {
    return;
  }
  const std::string state = describeState(getSearchState());
  if (state.empty()) {
    return;
  }
  shown_ = now;
  const std::string text = state + ", " + describeDuration(now);
  if (width_ == 0) {
    write_("twinmap: " + text + "\n");
    return;
  }
  const std::size_t most = width_ - 1;  // what reaches the last column is not one line
  write_(kClearLine + (text.size() <= most ? text : text.substr(0, most)));
  is_on_terminal_ = true;
}

void SearchLine::clear() {
  if (is_on_terminal_) {
    write_(kClearLine);
    is_on_terminal_ = false;
  }
}

}  // namespace twinmap
