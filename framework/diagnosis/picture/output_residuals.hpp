#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/diagnosis/picture/fit_motion.hpp"

namespace twinmap {

/// What a model leaves of an output in one recording, in noise standard deviations (whitened).
struct OutputResidual {
  std::size_t output = 0, recording = 0;
  Eigen::VectorXd times;              ///< n, s
  Eigen::VectorXd before, after;      ///< n; `after` is empty where no term was found
  Eigen::MatrixXd positions, speeds;  ///< n x coordinates of `motion`
};

/// Of the outputs whose samples have times, of the first `count` recordings. Throws as FitMotion::simulate().
std::vector<OutputResidual> listOutputResiduals(const Diagnosis& diagnosis, const ExperimentSpec& experiment,
                                                const RecordedFeatures& recordings, const FitMotion& motion,
                                                std::size_t count);

}  // namespace twinmap
