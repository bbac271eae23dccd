#pragma once

#include <nlohmann/json_fwd.hpp>

namespace twinmap {

/// JSON whose objects keep the order in which their keys were written.
using Json = nlohmann::ordered_json;

}  // namespace twinmap
