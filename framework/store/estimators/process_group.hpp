#pragma once

#include <memory>
#include <string>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "kernels/gp/online/process.hpp"

namespace twinmap {

/// Writes all that a process consists of into a group; the training inputs that exact ones share are left to
/// the caller.
void writeProcess(Hdf5Writer& file, const std::string& group, const gp::Process& process);

/// Reads it back, bit for bit. `inputs`: the training inputs; unused for sparse processes.
gp::Process readProcess(const Hdf5Reader& file, const std::string& group,
                        std::shared_ptr<const Eigen::MatrixXd> inputs);

/// Whether the group holds an exact process, which needs the training inputs.
bool isExactProcess(const Hdf5Reader& file, const std::string& group);

gp::ModelStructure readStructure(const Hdf5Reader& file, const std::string& group);
gp::Hyperparameters readHyperparameters(const Hdf5Reader& file, const std::string& group);

}  // namespace twinmap
