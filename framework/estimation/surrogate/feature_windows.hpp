#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"

namespace twinmap {

/// Components of features that vary less, in standard deviations of the noise, count as noise.
inline constexpr double kSmallestStddev = 0.2;

/// Features that are learnt together, by their indices.
using FeatureWindow = std::vector<Eigen::Index>;

/// Parts features into windows: samples of outputs by their time, those of at most 8 times a window, of all
/// outputs; features without a time of their own in order, those of one output and unit, at most 16 a window.
/// Within a short time a response follows few numbers that are smoother functions of the parameters than
/// those of the whole response, whose phase they shift.
std::vector<FeatureWindow> makeFeatureWindows(const std::vector<FeatureInfo>& infos);

/// Windows of `count` numbers of which nothing is known but their order.
std::vector<FeatureWindow> makeWindowsInOrder(Eigen::Index count);

}  // namespace twinmap
