
#include "framework/base/text/source_location.hpp"
#include "framework/python/bindings.hpp"
#include "framework/robots/estimate_file.hpp"
#include "framework/robots/experiment_text.hpp"
#include "framework/robots/robot_values.hpp"
#include "framework/robots/urdf/read_urdf.hpp"
#include "framework/robots/urdf/write_urdf.hpp"

namespace twinmap::python {
namespace {

namespace nb = nanobind;
using Texts = std::vector<std::string>;

/// The experiment, and what it leaves out of the file.
std::pair<std::string, Texts> importUrdf(const std::string& path, bool flies, const Texts& parameters,
                                         const Texts& joints, bool stops) {
  robots::Robot robot = robots::readUrdf(robots::XmlFile(path));
  robots::ImportOptions options;
  options.base = flies ? robots::Base::kFree : robots::Base::kFixed;
  options.parameters = parameters;
  options.joints = joints;
  options.stops = stops;
  const std::string experiment = robots::makeExperimentText(robot, options);
  return {experiment, robots::describeLeftOut(robot)};
}

/// The URDF with the values of an estimate (JSON of infer), and values, sds and status as JSON.
std::pair<std::string, std::string> updateUrdf(const std::string& path, const std::string& json,
                                               bool anyway) {
  const robots::RobotEstimate estimate = robots::readEstimate(json, "the estimate");
  if (!anyway) {
    robots::requireOk(estimate);
  }
  const robots::XmlFile file(path);
  const robots::Robot robot = robots::readUrdf(file);
  const robots::RobotValues values = robots::placeValues(robot, estimate.getMeans(), estimate.source);
  if (!values.exist) {
    throw ExperimentError(
        "a mass or a spread of the estimate is not above 0, or a loss below it: no robot has "
        "these numbers");
  }
  return {robots::writeUrdf(file, robot, values), robots::makeUpdateJson(estimate, values.without_place)};
}

}  // namespace

void bindRobots(nb::module_& module) {
  const auto release = nb::call_guard<nb::gil_scoped_release>();
  module.def("import_urdf", &importUrdf, nb::arg("path"), nb::arg("flies"), nb::arg("parameters"),
             nb::arg("joints"), nb::arg("stops"), release);
  module.def("update_urdf", &updateUrdf, nb::arg("path"), nb::arg("json"), nb::arg("anyway"), release);
}

}  // namespace twinmap::python
