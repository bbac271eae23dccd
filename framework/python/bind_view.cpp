
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/python/arrays.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/python_experiment.hpp"
#include "framework/view/make_scene.hpp"
#include "framework/view/page.hpp"
#include "framework/view/picture.hpp"

namespace twinmap::python {
namespace {

/// Page and picture of motions at points, a row each, which are called by `names`.
std::pair<std::string, std::string> view(const PythonExperiment& experiment, const Rows& points,
                                         const std::vector<std::string>& names) {
  const ExperimentSpec& spec = experiment.getSpec();
  requireOneTrial(spec, "a picture is of one");
  const Eigen::MatrixXd columns = viewColumns(points, countSampled(spec.model), "points");
  const nb::gil_scoped_release release;
  view::Scene scene = view::makeScene(spec, columns.col(0), names.front());
  for (Eigen::Index i = 1; i < columns.cols(); ++i) {
    view::addMotion(spec, columns.col(i), names[static_cast<std::size_t>(i)], scene);
  }
  return {view::makePage(scene), view::makePicture(scene)};
}

}  // namespace

void bindView(nb::module_& module) {
  module.def("view", &view, nb::arg("experiment"), nb::arg("points"), nb::arg("names"));
}

}  // namespace twinmap::python
