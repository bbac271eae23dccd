#pragma once

#include <stdexcept>
#include <string>

#include "framework/serve/live/measurement_service.hpp"

namespace twinmap::serve {

/// A body or message that cannot be read as JSON at all.
class NotJson : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads {"columns": {"t": [0, 0.1], "x [mm]": [1.5, null]}, "at": ..., "trial": ..., "name": ...}.
/// A cell that is missing is null; all but the columns may be left out. The text of the result is the
/// same table as CSV, whose numbers read back as the same bits. Throws NotJson, and ExperimentError, which
/// names the key and the rule, for JSON of another shape. O(cells).
PostedMeasurement readPostedJson(const std::string& body);

/// A message without a type: JSON where it begins with {, else CSV.
PostedMeasurement readPostedText(std::string body);

}  // namespace twinmap::serve
