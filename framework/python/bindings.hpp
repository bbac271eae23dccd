#pragma once

#include <pybind11/pybind11.h>

namespace twinmap::python {

// What each file adds to the module twinmap._twinmap, which twinmap/*.py wrap as a package.
void bindErrors(pybind11::module_& module);
void bindQuantity(pybind11::module_& module);
void bindExperiment(pybind11::module_& module);
void bindRuns(pybind11::module_& module);
void bindMap(pybind11::module_& module);
void bindJoint(pybind11::module_& module);
void bindDiagnosis(pybind11::module_& module);
void bindRobots(pybind11::module_& module);
void bindView(pybind11::module_& module);

}  // namespace twinmap::python
