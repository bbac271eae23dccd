#include "framework/sweep/stored_counts.hpp"

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
    for (const ModelGroup& part : splitByBounds(cases, group)) {
      const MatrixXd needed = dropFailed(collectNeighbourhoods(cases, part, all), samples);
      const auto neighbourhoods =
          openNeighbourhoodStore(part.model, makeLayout(part), store, StoreAccess::kReadOnly);
      addCounts(*neighbourhoods, needed, dropFailed(collectNeighbourhoods(cases, part, todo), samples),
                countNeighbours(collectUnknown(part.model).size()), counts.neighbourhoods);
    }
  }
  return counts;
}

}  // namespace twinmap
