#pragma once

#include <string>
#include <vector>

#include "framework/hdf5/hdf5_file.hpp"
#include "framework/online/online_model.hpp"

namespace twinmap {

/// Writes the processes of the online map and the trust model below /online; what the map shares with the
/// exact one (transform, targets, noise profile) is left to the caller. `parameters`: names, one per process.
void writeOnlineGroup(Hdf5Writer& file, const std::vector<std::string>& parameters, const OnlineModel& model);

/// Reads it back into a model whose shared parts the caller has set. `inputs`: training inputs of processes
/// that are exact; read on demand.
void readOnlineGroup(const Hdf5Reader& file, const std::vector<std::string>& parameters, OnlineModel& model);

}  // namespace twinmap
