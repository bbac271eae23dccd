#include "framework/estimation/trained/estimator_kinds.hpp"

#include <stdexcept>

#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"

namespace twinmap {
namespace {

struct EstimatorKind {
  const char* name;
  std::shared_ptr<const Estimator> (*load)(const Hdf5Reader& file, const std::string& group);
};

constexpr EstimatorKind kKinds[] = {
    {"gp", loadProcesses}, {"surrogate", loadSurrogate}, {"network", loadNetwork}};

}  // namespace

std::shared_ptr<const Estimator> loadEstimator(const std::string& kind, const Hdf5Reader& file,
                                               const std::string& group) {
  for (const EstimatorKind& known : kKinds) {
    if (kind == known.name) {
      return known.load(file, group);
    }
  }
  throw std::runtime_error(file.getPath() + ": unknown kind of map '" + kind + "'");
}

}  // namespace twinmap
