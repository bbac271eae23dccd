#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <memory>
#include <string>

namespace twinmap::python {

namespace py = pybind11;

/// A matrix whose rows follow one another in memory, as the columns of Eigen's do: (n, d) here is d x n
/// there.
using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The rows as columns, where they are: no copy. The array must outlive the view. Throws
/// std::invalid_argument, naming `what`, unless it has two dimensions with `width` columns.
inline Eigen::Map<const Eigen::MatrixXd> viewColumns(const Rows& rows, Eigen::Index width, const char* what) {
  if (rows.ndim() != 2 || rows.shape(1) != width) {
    throw std::invalid_argument(std::string(what) + ": must be an array of shape (n, " +
                                std::to_string(width) + ")");
  }
  return {rows.data(), width, static_cast<Eigen::Index>(rows.shape(0))};
}

/// Columns (d x n) become the array (n, d), which owns their memory: no copy.
inline py::array_t<double> moveToRows(Eigen::MatrixXd&& columns) {
  auto owned = std::make_unique<Eigen::MatrixXd>(std::move(columns));
  const py::array::ShapeContainer shape{owned->cols(), owned->rows()};
  double* data = owned->data();
  const py::capsule owner(owned.release(),
                          [](void* matrix) { delete static_cast<Eigen::MatrixXd*>(matrix); });
  return py::array_t<double>(shape, data, owner);
}

inline py::array_t<double> copyVector(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace twinmap::python
