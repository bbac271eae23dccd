#pragma once

#include <stdexcept>

namespace twinmap {

/// A run that was asked to stop (RunControl::stop): what was finished has been written.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace twinmap
