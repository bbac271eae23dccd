#include "framework/study/sweep/stored_counts.hpp"

#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/study/samples/stencils.hpp"
#include "framework/study/sweep/model_groups.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

/// Distinct points, and which of them a store lacks.
struct Sought {
  const MatrixXd& points;
  const std::vector<Eigen::Index> lacking;
};

void addCounts(const TrajectoryStore& store, const Sought& all, const Sought& todo, int simulations,
               PointCounts& counts) {
  const int missing = static_cast<int>(todo.lacking.size());
  counts.needed += static_cast<int>(all.points.cols());
  counts.stored += static_cast<int>(all.points.cols()) - static_cast<int>(all.lacking.size());
  counts.missing += missing;
  counts.simulations += simulations * missing;
  counts.bytes += missing > 0 ? static_cast<double>(calcChunkSize(store.getShape(), missing)) : 0.0;
}

/// Whether derivatives come from stencils. Nothing is simulated of a model that cannot be built.
bool needsStencils(const ModelGroup& group) {
  try {
    return !makeSimulator(group.model, group.times, group.modes)->hasDerivatives();
  } catch (const ExperimentError&) {
    return false;
  }
}

/// What is asked for at the points of `all` and `todo`, one value a case.
struct AskedPoints {
  const std::vector<SweepCase>& cases;
  const std::vector<bool>& all;
  const std::vector<bool>& todo;
};

void addStencils(const AskedPoints& asked, const ModelGroup& group, const TrajectoryStore& samples,
                 const std::filesystem::path& store, PointCounts& counts) {
  if (collectDerivativePoints(asked.cases, group, asked.all).cols() == 0 || !needsStencils(group)) {
    return;
  }
  for (const ModelGroup& part : splitByBounds(asked.cases, group)) {
    const auto stencils = openStencilStore(part.model, makeLayout(part), store, StoreAccess::kReadOnly);
    const MatrixXd all = dropFailed(collectDerivativePoints(asked.cases, part, asked.all), samples);
    const MatrixXd todo = dropFailed(collectDerivativePoints(asked.cases, part, asked.todo), samples);
    addCounts(*stencils, {all, stencils->findMissing(all)}, {todo, stencils->findMissing(todo)},
              countNeighbours(collectUnknown(part.model).size()), counts);
  }
}

/// Where all cases are to be done, as in a new experiment, the points are collected once.
void addSamples(const AskedPoints& asked, const ModelGroup& group, const TrajectoryStore& samples,
                StoredCounts& counts) {
  const MatrixXd points = collectPoints(asked.cases, group, asked.all);
  const Sought all{points, samples.findMissing(points)};
  if (asked.todo == asked.all) {
    addCounts(samples, all, all, 1, counts.samples);
  } else {
    const MatrixXd todo = collectPoints(asked.cases, group, asked.todo);
    addCounts(samples, all, {todo, samples.findMissing(todo)}, 1, counts.samples);
  }
  const std::size_t first = counts.lacking.size();
  counts.lacking.resize(first + static_cast<std::size_t>(points.cols()));
  for (const Eigen::Index column : all.lacking) {
    counts.lacking[first + static_cast<std::size_t>(column)] = true;
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
    addSamples({cases, all, todo}, group, samples, counts);
    addStencils({cases, all, todo}, group, samples, store, counts.stencils);
  }
  return counts;
}

}  // namespace twinmap
