#pragma once

#include <string>

#include "framework/report/panel.hpp"

namespace twinmap {

/// A measured output and its models, in a table of the page with the columns time, measured, nominal, updated
/// and noise_stddev.
struct ResponseData {
  std::string table;
  std::string output, unit;
  std::string which =
      {};  ///< of the table's cases: "best"; "" if the table holds one response, of one output
  std::string measured = "measured";  ///< what the points are called
};

struct ResponseLook {
  bool band = false;  ///< around the updated model, from column lower to upper
  bool zoom = false;  ///< the reader may drag and scroll the axis of time
};

/// The measured output over time, the nominal and the updated model.
Panel makeResponsePanel(const ResponseData& data, const ResponseLook& look = {});

/// The residual of the updated model in standard deviations of the noise over time, and the band of +-2.
Panel makeResidualPanel(const ResponseData& data, const ResponseLook& look = {});

}  // namespace twinmap
