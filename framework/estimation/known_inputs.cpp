#include "framework/estimation/known_inputs.hpp"

#include <fmt/core.h>

#include <stdexcept>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

Eigen::MatrixXd KnownInputs::scale(const Eigen::MatrixXd& values) const {
  if (values.rows() != center.size()) {
    throw std::invalid_argument(
        fmt::format("a map needs the values of its {} known inputs, not {}", center.size(), values.rows()));
  }
  return (values.colwise() - center).array().colwise() / half_width.array();
}

KnownInputs makeKnownInputs(const std::vector<ParameterSpec>& inputs) {
  return {calcBoxCenter(inputs), 0.5 * calcWidths(inputs)};
}

}  // namespace twinmap
