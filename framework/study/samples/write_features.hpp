#pragma once

#include <filesystem>

#include "framework/base/log/run_control.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/study/samples/sample_source.hpp"

namespace twinmap {

/// Simulates the training and test samples of an experiment, as far as the store lacks them, and writes their
/// points and their features with noise to an HDF5 file (docs/reference/files.md): those that a run would
/// learn from and be tested with, bit for bit. Samples are taken `block` at a time (8192 responses of 200
/// numbers are 13 MB), so that memory does not grow with their number but for their points and the store's
/// index, some 250 bytes each. Throws Interrupted where `control` stops it, after which the same call
/// continues; std::runtime_error if more samples fail than simulation.allowed_failures permits, or the file
/// cannot be written. Cost: that of the simulations, and 2 us a sample of 200 features.
void writeFeatures(const std::filesystem::path& file, const ExperimentSpec& experiment,
                   const FeatureExtractor& extractor, const SampleSource& source, const RunControl& control,
                   Eigen::Index block = 8192);

}  // namespace twinmap
