#include "framework/base/text/source_location.hpp"
#include "framework/data/measurement/files/table.hpp"
#include "framework/python/bindings.hpp"

namespace twinmap::python {
namespace {

namespace py = pybind11;

py::object textOrNone(const std::string& text) {
  return text.empty() ? py::object(py::none()) : py::object(py::str(text));
}

py::object numberOrNone(int number) {
  return number == 0 ? py::object(py::none()) : py::object(py::int_(number));
}

/// Raises the exception of that name, with the parts of the message as attributes.
void raise(const char* name, const ExperimentError& error) {
  const py::object type = py::module_::import("twinmap._errors").attr(name);
  py::dict parts;
  if (const InputProblem* problem = error.getProblem()) {
    parts["file"] = textOrNone(problem->where.file);
    parts["line"] = numberOrNone(problem->where.line);
    parts["column"] = numberOrNone(problem->where.column);
    parts["key"] = textOrNone(problem->where.key_path);
    parts["value"] = textOrNone(problem->value);
    parts["rule"] = textOrNone(problem->rule);
  }
  const py::object raised = type(py::str(error.what()), **parts);
  PyErr_SetObject(type.ptr(), raised.ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    std::rethrow_exception(std::move(pointer));
  } catch (const MeasurementError& error) {
    raise("MeasurementError", error);
  } catch (const ExperimentError& error) {
    raise("ExperimentError", error);
  }
}

}  // namespace

void bindErrors(py::module_&) {
  py::register_local_exception_translator(&translate);
}

}  // namespace twinmap::python
