#include "framework/python/quantity.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "framework/python/bindings.hpp"

namespace twinmap::python {
namespace {

namespace nb = nanobind;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string toText(const Quantity& quantity) {
  const std::string unit = quantity.unit.empty() ? "" : " " + quantity.unit;
  return std::isnan(quantity.lower)
             ? quantity.name + unit
             : fmt::format("{}: [{:g}, {:g}]{}", quantity.name, quantity.lower, quantity.upper, unit);
}

}  // namespace

std::vector<Quantity> describe(const std::vector<ParameterSpec>& parameters) {
  std::vector<Quantity> quantities;
  for (const ParameterSpec& parameter : parameters) {
    quantities.push_back({parameter.name.text, parameter.unit, parameter.description, parameter.bounds.lower,
                          parameter.bounds.upper});
  }
  return quantities;
}

std::vector<Quantity> describe(const std::vector<FeatureInfo>& features) {
  std::vector<Quantity> quantities;
  for (const FeatureInfo& feature : features) {
    quantities.push_back({feature.name, feature.unit, "", kNaN, kNaN});
  }
  return quantities;
}

std::vector<Quantity> describeOutputs(const ResponseLayout& layout) {
  std::vector<Quantity> quantities;
  for (std::size_t i = 0; i < layout.output_names.size(); ++i) {
    quantities.push_back({layout.output_names[i], layout.output_units[i], "", kNaN, kNaN});
  }
  return quantities;
}

void bindQuantity(nb::module_& module) {
  nb::class_<Quantity>(module, "Quantity", "A parameter, feature, known input or output")
      .def_ro("name", &Quantity::name)
      .def_ro("unit", &Quantity::unit)
      .def_ro("description", &Quantity::description)
      .def_ro("lower", &Quantity::lower)
      .def_ro("upper", &Quantity::upper)
      .def("__repr__", &toText);
}

}  // namespace twinmap::python
