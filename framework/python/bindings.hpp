#pragma once

#include <nanobind/nanobind.h>
// what is passed as Python's own values
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

namespace twinmap::python {

// What each file adds to the module twinmap._twinmap, which twinmap/*.py wrap as a package.
void bindErrors(nanobind::module_& module);
void bindQuantity(nanobind::module_& module);
void bindExperiment(nanobind::module_& module);
void bindRuns(nanobind::module_& module);
void bindMap(nanobind::module_& module);
void bindJoint(nanobind::module_& module);
void bindDiagnosis(nanobind::module_& module);
void bindRobots(nanobind::module_& module);
void bindTrack(nanobind::module_& module);
void bindView(nanobind::module_& module);

}  // namespace twinmap::python
