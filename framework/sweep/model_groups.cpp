#include "framework/sweep/model_groups.hpp"

#include <algorithm>
#include <map>
#include <unordered_set>

#include "framework/design/experiment_points.hpp"
#include "framework/features/feature_extractor.hpp"
#include "framework/sampling/model_store.hpp"
#include "framework/sampling/neighbourhoods.hpp"
#include "framework/sampling/trajectory_content.hpp"
#include "framework/spec/check/check_experiment.hpp"
#include "framework/spec/check/check_features.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {
namespace {

/// Equal texts for cases that may share simulations.
std::string makeGroupKey(const ExperimentSpec& experiment) {
  ResponseLayout layout;
  layout.output_names = collectNames(experiment.model.outputs);
  layout.modes = countModes(experiment.features);
  const Eigen::VectorXd times = collectTimes(experiment.features);
  if (times.size() > 0 && experiment.model.simulation.integrator != Integrator::kDopri5) {
    layout.times = times;
  }
  const std::string integrated = times.size() > 0 ? "integrated\n" : "";
  return integrated + writeTrajectoryContent(experiment.model, layout);
}

Eigen::VectorXd uniteTimes(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  std::vector<double> times;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(times));
  return Eigen::Map<Eigen::VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
}

/// Collects distinct columns in the order they come.
class PointSet {
 public:
  void add(const Eigen::MatrixXd& points) {
    for (const auto& column : points.colwise()) {
      const Eigen::VectorXd point = column;
      const std::string bits(reinterpret_cast<const char*>(point.data()), point.size() * sizeof(double));
      if (seen_.insert(bits).second) {
        values_.insert(values_.end(), point.begin(), point.end());
      }
    }
  }

  Eigen::MatrixXd get(Eigen::Index rows) const {
    return Eigen::Map<const Eigen::MatrixXd>(values_.data(), rows,
                                             static_cast<Eigen::Index>(values_.size()) / rows);
  }

 private:
  std::unordered_set<std::string> seen_;
  std::vector<double> values_;
};

bool haveEqualBounds(const std::vector<ParameterSpec>& a, const std::vector<ParameterSpec>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const ParameterSpec& one, const ParameterSpec& other) {
                      return one.bounds.lower == other.bounds.lower && one.bounds.upper == other.bounds.upper;
                    });
}

ModelGroup startGroup(const ExperimentSpec& experiment) {
  ModelGroup group;
  group.model = experiment.model;
  group.modes = countModes(experiment.features);
  return group;
}

}  // namespace

std::vector<ModelGroup> groupByModel(const std::vector<SweepCase>& cases) {
  std::vector<ModelGroup> groups;
  std::map<std::string, std::size_t> group_of_key;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const ExperimentSpec& experiment = cases[i].experiment;
    const auto [found, is_new] = group_of_key.emplace(makeGroupKey(experiment), groups.size());
    if (is_new) {
      groups.push_back(startGroup(experiment));
    }
    ModelGroup& group = groups[found->second];
    group.cases.push_back(static_cast<int>(i));
    group.times = uniteTimes(group.times, collectTimes(experiment.features));
    SimulationSpec& shared = group.model.simulation;
    const SimulationSpec& own = experiment.model.simulation;
    shared.max_wall_time = std::max(shared.max_wall_time, own.max_wall_time);
    shared.allowed_failures = std::max(shared.allowed_failures, own.allowed_failures);
  }
  return groups;
}

Eigen::MatrixXd collectPoints(const std::vector<SweepCase>& cases, const ModelGroup& group,
                              const std::vector<bool>& wanted) {
  PointSet points;
  for (const int member : group.cases) {
    if (wanted[member]) {
      const ExperimentSpec& e = cases[member].experiment;
      points.add(sampleTrainPoints(e));
      points.add(sampleTestPoints(e));
    }
  }
  return points.get(countSampled(group.model));
}

std::vector<ModelGroup> splitByBounds(const std::vector<SweepCase>& cases, const ModelGroup& group) {
  std::vector<ModelGroup> parts;
  for (const int member : group.cases) {
    const ModelSpec& model = cases[member].experiment.model;
    auto part = std::find_if(parts.begin(), parts.end(), [&](const ModelGroup& other) {
      return haveEqualBounds(collectUnknown(other.model), collectUnknown(model));
    });
    if (part == parts.end()) {
      part = parts.insert(parts.end(), group);
      part->cases.clear();
      part->model = model;
      part->model.simulation = group.model.simulation;
    }
    part->cases.push_back(member);
  }
  return parts;
}

Eigen::MatrixXd collectDerivativePoints(const std::vector<SweepCase>& cases, const ModelGroup& group,
                                        const std::vector<bool>& wanted) {
  PointSet points;
  for (const int member : group.cases) {
    if (wanted[member]) {
      points.add(listDerivativePoints(cases[member].experiment));
    }
  }
  return points.get(countSampled(group.model));
}

TrajectoryStore openToRead(const ModelGroup& group, const std::filesystem::path& root) {
  const ResponseLayout layout = makeLayout(group);
  return {root, writeStoreContent(group.model, layout), countSampled(group.model), layout.getRowCount(),
          StoreAccess::kReadOnly};
}

ResponseLayout makeLayout(const ModelGroup& group) {
  ResponseLayout layout;
  layout.output_names = collectNames(group.model.outputs);
  layout.times = group.times;
  layout.modes = group.modes;
  return layout;
}

}  // namespace twinmap
