#pragma once

#include <map>
#include <stdexcept>
#include <string>

namespace twinmap::serve {

/// A target that cannot be read: its message says what breaks which rule.
class BadTarget : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "/measurements?at=12" in parts.
struct RequestTarget {
  std::string path;                          ///< as it was sent: one that is written otherwise is another
  std::map<std::string, std::string> query;  ///< decoded
};

/// Throws BadTarget where it does not begin with /, a key stands twice, or a % is not followed by two
/// hexadecimal digits.
RequestTarget parseTarget(const std::string& target);

}  // namespace twinmap::serve
