#pragma once

#include <string>

#include "framework/report/figure.hpp"

namespace twinmap {

/// A measured output and its models, in a table of the page with the columns time, measured, nominal, updated
/// and noise_stddev.
struct ResponseData {
  std::string table;
  Json transforms = Json::array();  ///< Vega-Lite transforms that leave the rows of the response
  std::string output, unit;
  std::string which;  ///< response it is, for those who cannot see: "best case"; "" if there is one
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
