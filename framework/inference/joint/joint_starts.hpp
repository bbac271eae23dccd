#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/posterior_problem.hpp"
#include "framework/inference/joint/recording_inference.hpp"

namespace twinmap {

/// Starts of a search of several recordings together (all unknown parameters x n). Each has what one
/// recording alone found for the machine, its first `shared` parameters, beside what the others found for
/// themselves. The last one has the mean of all, weighted by their information. Each could be simulated
/// alone.
Eigen::MatrixXd listJointStarts(const PosteriorProblem& problem, const std::vector<RecordingInference>& alone,
                                Eigen::Index shared);

}  // namespace twinmap
