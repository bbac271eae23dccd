#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <memory>
#include <string>

namespace twinmap::python {

namespace nb = nanobind;

/// A matrix whose rows follow one another in memory, as the columns of Eigen's do: (n, d) here is d x n
/// there.
using Rows = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Array = nb::object;  // of numpy

/// The array that looks at memory which its owner holds.
inline Array makeArray(double* data, std::initializer_list<std::size_t> shape, const nb::capsule& owner) {
  return nb::cast(nb::ndarray<nb::numpy, double>(data, shape, owner));
}

/// The rows as columns, where they are: no copy. The array must outlive the view. Throws
/// std::invalid_argument, naming `what`, unless it has two dimensions with `width` columns.
inline Eigen::Map<const Eigen::MatrixXd> viewColumns(const Rows& rows, Eigen::Index width, const char* what) {
  if (rows.ndim() != 2 || static_cast<Eigen::Index>(rows.shape(1)) != width) {
    throw std::invalid_argument(std::string(what) + ": must be an array of shape (n, " +
                                std::to_string(width) + ")");
  }
  return {rows.data(), width, static_cast<Eigen::Index>(rows.shape(0))};
}

/// Columns (d x n) become the array (n, d), which owns their memory: no copy.
inline Array moveToRows(Eigen::MatrixXd&& columns) {
  auto owned = std::make_unique<Eigen::MatrixXd>(std::move(columns));
  const auto shape = {static_cast<std::size_t>(owned->cols()), static_cast<std::size_t>(owned->rows())};
  double* data = owned->data();
  const nb::capsule owner(owned.release(),
                          [](void* matrix) noexcept { delete static_cast<Eigen::MatrixXd*>(matrix); });
  return makeArray(data, shape, owner);
}

inline Array copyVector(const Eigen::Ref<const Eigen::VectorXd>& values) {
  auto owned = std::make_unique<Eigen::VectorXd>(values);
  const auto shape = {static_cast<std::size_t>(owned->size())};
  double* data = owned->data();
  const nb::capsule owner(owned.release(),
                          [](void* vector) noexcept { delete static_cast<Eigen::VectorXd*>(vector); });
  return makeArray(data, shape, owner);
}

}  // namespace twinmap::python
