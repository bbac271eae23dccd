#pragma once

#include "framework/base/text/source_location.hpp"

namespace twinmap {

/// A closed interval, lower < upper, both finite.
struct Bounds {
  double lower = 0.0, upper = 0.0;
  SourceLocation where;

  bool isGiven() const { return lower < upper; }
};

}  // namespace twinmap
