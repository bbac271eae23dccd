#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "framework/data/measurement/make_table.hpp"

namespace twinmap::python {

namespace py = pybind11;

using Vector = py::array_t<double, py::array::c_style | py::array::forcecast>;
using NamedVectors = std::vector<std::pair<std::string, Vector>>;

/// Throws MeasurementError for an array of other than one dimension; `what` names it.
inline Eigen::Map<const Eigen::VectorXd> viewVector(const Vector& values, const std::string& what) {
  if (values.ndim() != 1) {
    throw MeasurementError(what + ": must be an array of one dimension");
  }
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

inline std::vector<NamedColumn> viewNamed(const NamedVectors& columns) {
  std::vector<NamedColumn> named;
  for (const auto& [name, values] : columns) {
    named.push_back({name, viewVector(values, "column '" + name + "'")});
  }
  return named;
}

}  // namespace twinmap::python
