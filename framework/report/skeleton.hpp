#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "framework/report/panel.hpp"

namespace twinmap {

/// The Vega-Lite specification of a panel: its skeleton, filled, without the examples of data. A skeleton,
/// slot or text that does not exist is a bug (assert).
nlohmann::ordered_json makeSpec(const Panel& panel);

/// What a reader who cannot see the panel should know: its specification's description.
std::string describePanel(const Panel& panel);

}  // namespace twinmap
