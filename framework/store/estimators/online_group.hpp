#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/trained/online_model.hpp"

namespace twinmap {

/// Writes the online map and the trust model below /online: of a surrogate what the trust model's lacks, a
/// network whole, of
/// processes those that are compressed; what these share with the exact ones (transform, targets, noise
/// profile) is left to the caller. `parameters`: names.
void writeOnlineGroup(Hdf5Writer& file, const std::vector<std::string>& parameters, const OnlineModel& model);

/// Whether the map is a surrogate.
bool holdsSurrogate(const Hdf5Reader& file);

/// Whether it is a network.
bool holdsNetwork(const Hdf5Reader& file);

/// None where the run could fit none.
std::optional<TrustModel> readTrustModel(const Hdf5Reader& file);

/// The surrogate, its forward part that of the trust model.
std::shared_ptr<const Surrogate> readSurrogate(const Hdf5Reader& file, const TrustModel& trust);

/// The network; it predicts bit for bit as the one that was written.
std::shared_ptr<const NetworkMap> readNetwork(const Hdf5Reader& file);

/// Reads the processes into a map whose shared parts the caller has set; those that are not compressed are
/// the exact ones.
void readOnlineProcesses(const Hdf5Reader& file, const std::vector<std::string>& parameters, GpMap& map);

}  // namespace twinmap
