#pragma once

#include <string>

#include "framework/base/json/json_fwd.hpp"
#include "framework/report/panel.hpp"

namespace twinmap {

/// The Vega-Lite specification of a panel: its skeleton, filled, without the examples of data. A skeleton,
/// slot or text that does not exist is a bug (assert).
Json makeSpec(const Panel& panel);

/// What a reader who cannot see the panel should know: its specification's description.
std::string describePanel(const Panel& panel);

}  // namespace twinmap
