#include "framework/view/picture.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/escape.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/view/drawing.hpp"
#include "framework/view/make_scene.hpp"

namespace twinmap::view {
namespace {

/// Of a model from elsewhere: its outputs over time, one below the other.
std::string drawSignals(const Scene& scene) {
  const Eigen::MatrixXd& outputs = scene.motions.front().outputs;
  const double height =
      (kPictureHeight - kPictureMargin) / static_cast<double>(std::max<Eigen::Index>(outputs.rows(), 1));
  std::string text;
  for (Eigen::Index i = 0; i < outputs.rows(); ++i) {
    const double low = outputs.row(i).minCoeff(), range = std::max(outputs.row(i).maxCoeff() - low, 1e-300);
    const double bottom = 0.5 * kPictureMargin + height * static_cast<double>(i + 1);
    std::string points;
    for (Eigen::Index k = 0; k < outputs.cols(); ++k) {
      const double share =
          static_cast<double>(k) / static_cast<double>(std::max<Eigen::Index>(outputs.cols() - 1, 1));
      points += fmt::format("{:.0f},{:.1f} ", kPictureMargin + share * (kPictureWidth - 2.0 * kPictureMargin),
                            bottom - (outputs(i, k) - low) / range * (height - 20.0));
    }
    const SceneOutput& output = scene.outputs[static_cast<std::size_t>(i)];
    text += fmt::format("<polyline class=\"signal\" points=\"{}\"/>\n<text x=\"{}\" y=\"{:.1f}\">{}</text>\n",
                        points, kPictureMargin, bottom - height + 14.0,
                        escapeHtml(output.name + (output.unit.empty() ? "" : " [" + output.unit + "]")));
  }
  return text;
}

}  // namespace

std::string makePicture(const Scene& scene) {
  std::string text = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" class="mechanism" viewBox="0 0 {0:.0f} {1:.0f}" role="img" aria-label="{2}">)",
      kPictureWidth, kPictureHeight, escapeHtml("mechanism " + scene.name));
  text += "\n" + std::string(kPictureStyle);
  if (scene.bodies.empty()) {
    text += drawSignals(scene);
  } else {
    const Poses& poses = scene.motions.front().poses.front();
    text += drawMechanism(scene, fitCamera(scene, {&poses}), poses);
  }
  return text + "</svg>\n";
}

std::string makePicture(const ExperimentSpec& experiment) {
  if (!experiment.trials.empty()) {
    return makePicture(experiment.trials.front().experiment);
  }
  if (experiment.model.source) {
    return "";
  }
  return makePicture(makeStill(experiment, calcBoxCenter(collectSampled(experiment.model))));
}

}  // namespace twinmap::view
