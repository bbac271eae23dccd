#pragma once

#include <string>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// The mechanism at its first instant as SVG, light or dark as the reader's screen is: bodies as the outlines
/// of their ellipsoids, joints, lines and marks. Seen from the front right above, or along z where all joints
/// turn about z.
std::string makePicture(const Scene& scene);

/// The picture of an experiment, of its first trial where there are several, at the centre of the bounds; ""
/// of a model from elsewhere, which has no bodies. Throws as makeScene does.
std::string makePicture(const ExperimentSpec& experiment);

}  // namespace twinmap::view
