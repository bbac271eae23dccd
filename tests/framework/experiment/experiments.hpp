#pragma once

#include <string>

namespace twinmap {

inline const std::string kTable1 = std::string(TWINMAP_SOURCE_DIR) + "/experiments/two_beam/table1.yaml";
inline const std::string kCart = std::string(TWINMAP_SOURCE_DIR) + "/experiments/duffing/cart.yaml";

}  // namespace twinmap
