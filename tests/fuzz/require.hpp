#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

/// Ends a fuzzer where something does not hold, and prints what, and the text that shows it.
inline void require(bool holds, const char* what, const std::string& text) {
  if (!holds) {
    std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
    std::abort();
  }
}
