#include "framework/study/sweep/model_groups.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <unordered_set>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/check/check_features.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/samples/stencils.hpp"
#include "framework/study/samples/trajectory_content.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

std::string_view getBits(const double* values, Eigen::Index count) {
  return {reinterpret_cast<const char*>(values), static_cast<std::size_t>(count) * sizeof(double)};
}

/// Equal texts for cases that may share simulations; that of each model is written once.
class GroupKeys {
 public:
  const std::string& get(const SweepCase& one, const Eigen::VectorXd& times) {
    const ModelSpec& model = one.experiment.model;
    ResponseLayout layout;
    layout.output_names = collectNames(model.outputs);
    layout.modes = countModes(one.experiment.features);
    if (model.simulation.engine == Engine::kSimbody && !model.system.constraints.empty()) {
      layout.times = times;
    }
    const std::string of_layout(getBits(layout.times.data(), layout.times.size()));
    std::string& key = keys_[{one.model, layout.modes, times.size() > 0, of_layout}];
    if (key.empty()) {
      key = (times.size() > 0 ? "integrated\n" : "") + writeTrajectoryContent(model, layout);
    }
    return key;
  }

 private:
  /// By model, modes, whether there are times, and those that decide.
  std::map<std::tuple<int, int, bool, std::string>, std::string> keys_;
};

Eigen::VectorXd uniteTimes(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  std::vector<double> times;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(times));
  return Eigen::Map<Eigen::VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
}

/// Collects distinct columns in the order they come.
class PointSet {
 public:
  void add(const MatrixXd& points) {
    std::vector<Eigen::Index> fresh;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      if (seen_.count(getBits(points.col(i).data(), points.rows())) == 0) {
        fresh.push_back(i);
      }
    }
    kept_.emplace_back(points(Eigen::all, fresh));
    for (Eigen::Index i = 0; i < kept_.back().cols(); ++i) {
      const double* point = kept_.back().col(i).data();
      if (seen_.insert(getBits(point, points.rows())).second) {
        distinct_.push_back(point);
      }
    }
  }

  MatrixXd get(Eigen::Index rows) const {
    MatrixXd points(rows, static_cast<Eigen::Index>(distinct_.size()));
    for (std::size_t i = 0; i < distinct_.size(); ++i) {
      std::copy_n(distinct_[i], rows, points.col(static_cast<Eigen::Index>(i)).data());
    }
    return points;
  }

 private:
  std::vector<MatrixXd> kept_;  ///< what the others look into
  std::unordered_set<std::string_view> seen_;
  std::vector<const double*> distinct_;
};

/// Equal for cases with the same points of a set.
using SetKey = std::tuple<int, std::uint64_t, DesignMethod, int, int>;

SetKey makeSetKey(const SweepCase& one, const PointSetSpec& set) {
  return {one.model, one.experiment.seed, set.method, set.samples.number, set.smallest.value_or(0)};
}

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
  GroupKeys keys;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const ExperimentSpec& experiment = cases[i].experiment;
    const Eigen::VectorXd times = collectTimes(experiment.features);
    const auto [found, is_new] = group_of_key.emplace(keys.get(cases[i], times), groups.size());
    if (is_new) {
      groups.push_back(startGroup(experiment));
    }
    ModelGroup& group = groups[found->second];
    group.cases.push_back(static_cast<int>(i));
    group.times = uniteTimes(group.times, times);
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
  std::set<SetKey> train, test;
  for (const int member : group.cases) {
    if (wanted[member]) {
      const ExperimentSpec& e = cases[member].experiment;
      if (train.insert(makeSetKey(cases[member], e.design.train)).second) {
        points.add(sampleTrainPoints(e));
      }
      if (test.insert(makeSetKey(cases[member], e.design.test)).second) {
        points.add(sampleTestPoints(e));
      }
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
  std::set<std::tuple<SetKey, SetKey, bool, bool>> known;
  for (const int member : group.cases) {
    const ExperimentSpec& e = cases[member].experiment;
    const auto asked =
        std::make_tuple(makeSetKey(cases[member], e.design.train), makeSetKey(cases[member], e.design.test),
                        asksForInformationLimit(e), selectsByFisherInformation(e));
    if (wanted[member] && known.insert(asked).second) {
      points.add(listDerivativePoints(e));
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
