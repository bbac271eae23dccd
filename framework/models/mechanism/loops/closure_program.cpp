#include "framework/models/mechanism/loops/closure_program.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/experiment/model/named_forces.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/equations/calc_system_values.hpp"
#include "framework/models/mechanism/equations/constrained_motion.hpp"
#include "framework/models/mechanism/recorded_parameters.hpp"
#include "kernels/lanes/program/differentiate.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using program::Symbol;
using ClosureSymbols = std::vector<Symbol>;

void appendColumns(const ClosureSymbols& values, const ClosureSymbols& variables, ClosureSymbols& all) {
  for (const ClosureSymbols& column : program::calcJacobian(values, variables)) {
    all.insert(all.end(), column.begin(), column.end());
  }
}

program::Program compileClosures(const ModelSpec& model, const SystemNames& names) {
  program::Recorder recorder;
  const NamedValues<Symbol> values = recordParameters(model, recorder);
  const equations::SystemValues<Symbol> system = equations::calcSystemValues(model.system, names, values);
  const int n = system.coordinate_count;
  ClosureSymbols q, v, parameters, distances;
  std::vector<program::Seed> moving;
  for (int i = 0; i < n; ++i) {
    q.push_back(recorder.state(i));
    v.push_back(recorder.state(n + i));
    moving.push_back({q.back(), v.back()});
  }
  const int count = static_cast<int>(countSampled(model));
  for (int i = 0; i < count; ++i) {
    parameters.push_back(recorder.parameter(i));
  }
  const auto motions = equations::calcMotions(system, q, ClosureSymbols(n, Symbol(0.0)));
  const auto conditions = equations::calcClosureTerms(system, motions, q);
  for (const auto& terms : conditions) {
    distances.push_back(terms.value);
  }
  ClosureSymbols rates = program::calcTangents(distances, moving);
  const ClosureSymbols speeds = equations::calcSpeeds(system, q, v);
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    if (system.closures[k].kind == equations::ClosureKind::kRolling) {
      rates[k] = equations::dotRow(conditions[k].row, speeds);
    }
  }
  ClosureSymbols all = distances;
  appendColumns(distances, q, all);
  all.insert(all.end(), rates.begin(), rates.end());
  appendColumns(rates, q, all);
  appendColumns(rates, v, all);
  all.insert(all.end(), speeds.begin(), speeds.end());
  appendColumns(speeds, q, all);
  appendColumns(speeds, v, all);
  appendColumns(distances, parameters, all);
  appendColumns(rates, parameters, all);
  return program::compile(recorder, all, {2 * n, count, 0});
}

std::vector<ClosureLabel> makeLabels(const ModelSpec& model, const SystemNames& names) {
  std::vector<ClosureLabel> labels;
  for (std::size_t i = 0; i < model.system.constraints.size(); ++i) {
    const ConstraintSpec& spec = model.system.constraints[i];
    const std::string text = spec.name ? fmt::format("constraint '{}'", spec.name->text)
                                       : fmt::format("system.constraints[{}] ({})", i, getKind(spec));
    const char* unit =
        spec.gear ? getUnit(names.getCoordinates()[names.findCoordinate(spec.gear->coordinate)].traits.kind)
                  : "m";
    const std::size_t places = spec.coincident || spec.weld || spec.pin ? 3 : 1;
    labels.insert(labels.end(), places, {text, unit, spec.where});
    const std::size_t directions = spec.weld ? 3 : spec.pin ? 2 : 0;
    labels.insert(labels.end(), directions, {text, "rad", spec.where});
    labels.insert(labels.end(), spec.rolling ? 2 : 0, {text, "m/s", spec.where, true});
  }
  return labels;
}

/// Takes arrays one after the other, as they were recorded.
class ClosureReader {
 public:
  explicit ClosureReader(const VectorXd& all) : all_(all) {}
  VectorXd take(Index size) {
    const VectorXd values = all_.segment(next_, size);
    next_ += size;
    return values;
  }
  MatrixXd take(Index rows, Index columns) { return take(rows * columns).reshaped(rows, columns); }

 private:
  const VectorXd& all_;
  Index next_ = 0;
};

/// How far a unit of any coordinate moves each condition: lengths of levers in m, or 1. What rounding alone
/// moves, as out of the plane of a loop, is measured against the others.
VectorXd calcScales(const ClosureValues& at) {
  constexpr double kShare = 1e-2, kSmallest = 1e-9;
  const VectorXd largest = at.slopes.cwiseAbs().rowwise().maxCoeff();
  return largest.cwiseMax(std::max(kShare * largest.maxCoeff(), kSmallest));
}

}  // namespace

LoopModel recordLoops(const ModelSpec& model, const SystemNames& names) {
  LoopModel loops;
  loops.coordinates = static_cast<Index>(names.getCoordinateNames().size());
  loops.parameters = countSampled(model);
  loops.labels = makeLabels(model, names);
  loops.program = compileClosures(model, names);
  return loops;
}

ClosureValues ClosureProgram::calc(const VectorXd& parameters, const VectorXd& coordinates,
                                   const VectorXd& rates) {
  const Index n = model_.coordinates, m = static_cast<Index>(model_.labels.size()), p = model_.parameters;
  VectorXd states(2 * n);
  states << coordinates, rates;
  const VectorXd all = program_.calc({parameters, states});
  ClosureReader reader(all);
  ClosureValues values;
  values.distances = reader.take(m);
  values.slopes = reader.take(m, n);
  values.rates = reader.take(m);
  values.rate_slopes = reader.take(m, n);
  values.rate_columns = reader.take(m, n);
  for (Index k = 0; k < m; ++k) {
    if (!model_.labels[k].of_speeds) {
      values.rate_columns.row(k) = values.slopes.row(k);  // the same but for rounding
    }
  }
  values.speeds = reader.take(n);
  values.speed_slopes = reader.take(n, n);
  values.speed_columns = reader.take(n, n);
  values.forced = reader.take(m, p);
  values.forced_rates = reader.take(m, p);
  return values;
}

VectorXd closeLoops(ClosureProgram& program, const VectorXd& parameters, VectorXd start,
                    const std::vector<int>& rows, const std::vector<int>& columns) {
  constexpr int kMaxIterations = 50;
  constexpr double kShortest = 1e-6;   // part of a step, below which none helps
  constexpr double kRounding = 1e-15;  // of the lengths
  ClosureValues at = program.calc(parameters, start);
  const VectorXd weights = calcScales(at).cwiseInverse();
  double distance = at.distances(rows).cwiseProduct(weights(rows)).norm();
  for (int i = 0; i < kMaxIterations && distance > kRounding; ++i) {
    const MatrixXd slopes = at.slopes(rows, columns);
    const VectorXd step = linalg::solveMinimumNorm(slopes, at.distances(rows));
    double length = 1.0;
    for (bool nearer = false; !nearer && length > kShortest; length *= nearer ? 1.0 : 0.5) {
      VectorXd trial = start;
      trial(columns) -= length * step;
      ClosureValues there = program.calc(parameters, trial);
      const double trial_distance = there.distances(rows).cwiseProduct(weights(rows)).norm();
      nearer = trial_distance < distance;
      if (nearer) {
        start = std::move(trial);
        at = std::move(there);
        distance = trial_distance;
      }
    }
    if (length <= kShortest) {
      break;
    }
  }
  return start;
}

std::string describeOpenLoops(const LoopModel& model, const ClosureValues& at) {
  constexpr double kClosed = 1e-9;
  const VectorXd scales = calcScales(at);
  std::string text;
  for (Index k = 0; k < at.distances.size(); ++k) {
    if (!(std::abs(at.distances[k]) <= kClosed * scales[k])) {
      const ClosureLabel& label = model.labels[k];
      text += fmt::format("{}{} is open by {:.3g} {}", text.empty() ? "" : ", ", label.text,
                          std::abs(at.distances[k]), label.unit);
    }
  }
  return text;
}

}  // namespace twinmap
