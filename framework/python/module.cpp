#include <twinmap/build_info.hpp>

#include "framework/base/worker/worker_process.hpp"
#include "framework/models/fmu/worker.hpp"
#include "framework/python/bindings.hpp"
#include "framework/simulation/simulator_team.hpp"

NB_MODULE(_twinmap, module) {
  nanobind::set_leak_warnings(false);  // what still lives when the interpreter ends is the user's affair
  module.doc() = "The compiled part of the package twinmap";
  module.attr("__version__") = twinmap::kVersion;
  module.def(
      "set_worker_program",
      [](const std::string& executable, const std::vector<std::string>& arguments) {
        twinmap::setWorkerProgram({executable, arguments});
      },
      "How processes are started that run_worker() is called in");
  module.def("run_worker", &twinmap::fmi::runWorker, "Simulates FMUs for another process; never returns");
  module.def("get_default_threads", &twinmap::countThreads, "All cores, or OMP_NUM_THREADS");
  twinmap::python::bindErrors(module);
  twinmap::python::bindQuantity(module);
  twinmap::python::bindExperiment(module);
  twinmap::python::bindRuns(module);
  twinmap::python::bindMap(module);
  twinmap::python::bindJoint(module);
  twinmap::python::bindDiagnosis(module);
  twinmap::python::bindRobots(module);
  twinmap::python::bindTrack(module);
  twinmap::python::bindView(module);
}
