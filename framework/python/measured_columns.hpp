#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/data/measurement/files/make_table.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/inference/known_value.hpp"

namespace twinmap::python {

namespace nb = nanobind;

using Vector = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
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

/// What was measured: the columns; without these, the file that the name is of. Missing cells are kept.
inline Table readOrMakeTable(const std::string& name, const std::optional<NamedVectors>& columns,
                             const std::vector<std::string>& needed) {
  return columns ? makeTable(name, viewNamed(*columns), needed, MissingCells::kKeep)
                 : readTable(name, needed, MissingCells::kKeep);
}

using Known = std::vector<std::pair<std::string, double>>;

inline std::vector<KnownValue> listKnown(const Known& known) {
  std::vector<KnownValue> values;
  for (const auto& [name, value] : known) {
    values.push_back({name, value});
  }
  return values;
}

/// Values of the known inputs, in their order.
inline Eigen::VectorXd collectKnown(const std::vector<ParameterSpec>& inputs, const Known& known) {
  return twinmap::collectKnown(inputs, listKnown(known));
}

}  // namespace twinmap::python
