#include "framework/base/text/source_location.hpp"
#include "framework/data/measurement/files/table.hpp"
#include "framework/python/bindings.hpp"

namespace twinmap::python {
namespace {

namespace nb = nanobind;

nb::object textOrNone(const std::string& text) {
  return text.empty() ? nb::object(nb::none()) : nb::object(nb::str(text.c_str()));
}

nb::object numberOrNone(int number) {
  return number == 0 ? nb::object(nb::none()) : nb::object(nb::int_(number));
}

/// Raises the exception of that name, with the parts of the message as attributes.
void raise(const char* name, const ExperimentError& error) {
  const nb::object type = nb::module_::import_("twinmap._errors").attr(name);
  nb::dict parts;
  if (const InputProblem* problem = error.getProblem()) {
    parts["file"] = textOrNone(problem->where.file);
    parts["line"] = numberOrNone(problem->where.line);
    parts["column"] = numberOrNone(problem->where.column);
    parts["key"] = textOrNone(problem->where.key_path);
    parts["value"] = textOrNone(problem->value);
    parts["rule"] = textOrNone(problem->rule);
  }
  const nb::object raised = type(nb::str(error.what()), **parts);
  PyErr_SetObject(type.ptr(), raised.ptr());
}

void translate(const std::exception_ptr& pointer, void*) {
  try {
    std::rethrow_exception(pointer);
  } catch (const MeasurementError& error) {
    raise("MeasurementError", error);
  } catch (const ExperimentError& error) {
    raise("ExperimentError", error);
  }
}

}  // namespace

void bindErrors(nb::module_&) {
  nb::register_exception_translator(&translate);
}

}  // namespace twinmap::python
