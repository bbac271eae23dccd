#pragma once

#include <random>

#include "framework/models/mechanism/model_context.hpp"

namespace twinmap::testing {

inline InitialState makeRandomState(const ModelContext& context, int seed) {
  std::mt19937 generator(seed);
  const auto draw = [&generator] { return static_cast<double>(generator()) / 4294967296.0 - 0.5; };
  const Eigen::Index n = static_cast<Eigen::Index>(context.names.getCoordinateNames().size());
  return {Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return draw(); }),
          Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return 4.0 * draw(); })};
}

}  // namespace twinmap::testing
