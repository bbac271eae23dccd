#include "framework/sweep/stored_counts.hpp"

#include "framework/model_source/make_simulator.hpp"
#include "framework/sampling/neighbourhoods.hpp"
#include "framework/sensitivity/neighbourhood_simulator.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/sweep/model_groups.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

void addCounts(const TrajectoryStore& store, const MatrixXd& all, const MatrixXd& todo, int simulations,
               PointCounts& counts) {
  const int missing = static_cast<int>(store.findMissing(todo).size());
  counts.needed += static_cast<int>(all.cols());
  counts.stored += static_cast<int>(all.cols()) - static_cast<int>(store.findMissing(all).size());
  counts.missing += missing;
  counts.simulations += simulations * missing;
  counts.bytes += missing > 0 ? static_cast<double>(calcChunkSize(store.getShape(), missing)) : 0.0;
}

/// Whether derivatives come from neighbourhoods. Nothing is simulated of a model that cannot be built.
bool needsNeighbourhoods(const ModelGroup& group) {
  try {
    return !makeSimulator(group.model, group.times, group.modes)->hasDerivatives();
  } catch (const ExperimentError&) {
    return false;
  }
}

/// What is asked for at the points of `all` and `todo`, one value a case.
struct Asked {
  const std::vector<SweepCase>& cases;
  const std::vector<bool>& all;
  const std::vector<bool>& todo;
};

void addNeighbourhoods(const Asked& asked, const ModelGroup& group, const TrajectoryStore& samples,
                       const std::filesystem::path& store, PointCounts& counts) {
  if (collectDerivativePoints(asked.cases, group, asked.all).cols() == 0 || !needsNeighbourhoods(group)) {
    return;
  }
  for (const ModelGroup& part : splitByBounds(asked.cases, group)) {
    const auto neighbourhoods =
        openNeighbourhoodStore(part.model, makeLayout(part), store, StoreAccess::kReadOnly);
    addCounts(*neighbourhoods, dropFailed(collectDerivativePoints(asked.cases, part, asked.all), samples),
              dropFailed(collectDerivativePoints(asked.cases, part, asked.todo), samples),
              countNeighbours(collectUnknown(part.model).size()), counts);
  }
}

}  // namespace

StoredCounts countStored(const std::vector<SweepCase>& cases, const std::vector<bool>& complete,
                         const std::filesystem::path& store) {
  const std::vector<bool> all(cases.size(), true);
  std::vector<bool> todo = complete;
  todo.flip();
  StoredCounts counts;
  for (const ModelGroup& group : groupByModel(cases)) {
    const TrajectoryStore samples = openToRead(group, store);
    addCounts(samples, collectPoints(cases, group, all), collectPoints(cases, group, todo), 1,
              counts.samples);
    addNeighbourhoods({cases, all, todo}, group, samples, store, counts.neighbourhoods);
  }
  return counts;
}

}  // namespace twinmap
