#pragma once

#include <memory>
#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/estimator.hpp"

namespace twinmap {

/// Reads a trained estimator of a kind (Estimator::getKind()) from `group` of maps.h5; it infers bit for bit
/// as the one that was saved. Throws std::runtime_error for a kind that nobody knows, and for parts that are
/// missing or do not fit each other.
std::shared_ptr<const Estimator> loadEstimator(const std::string& kind, const Hdf5Reader& file,
                                               const std::string& group);

}  // namespace twinmap
