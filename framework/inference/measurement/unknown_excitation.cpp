#include "framework/inference/measurement/unknown_excitation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/estimation/levels.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/simulation/team_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One of the tables of a signal, and what is not known of it.
struct UnknownTable {
  std::size_t signal = 0, table = 0;
  std::vector<TableUnknown> changes;
};

/// The noise of a table's samples, independent from one stretch of them to the next.
void addNoise(const TableSpec& table, std::vector<TableUnknown>& changes) {
  constexpr std::size_t kMost = 500;  // each is a simulation
  const std::size_t all = table.values.size(), together = (all + kMost - 1) / kMost;
  for (std::size_t first = 0; first < all; first += together) {
    const std::size_t count = std::min(together, all - first);
    const double stddev = table.measured->noise / std::sqrt(static_cast<double>(count));
    changes.push_back({first, std::vector<double>(count, stddev)});
  }
}

void addTimes(const TableUnknown& change, double times, std::vector<double>& values) {
  for (std::size_t i = 0; i < change.changes.size(); ++i) {
    values[change.first + i] += times * change.changes[i];
  }
}

std::vector<UnknownTable> listUnknown(const ModelSpec& model) {
  std::vector<UnknownTable> all;
  for (std::size_t s = 0; s < model.excitation.size(); ++s) {
    const std::vector<TableSpec>& tables = model.excitation[s].tables;
    for (std::size_t t = 0; t < tables.size(); ++t) {
      UnknownTable unknown{s, t, tables[t].unknown};
      if (tables[t].measured && tables[t].measured->noise > 0.0) {
        addNoise(tables[t], unknown.changes);
      }
      all.push_back(std::move(unknown));
    }
  }
  return all;
}

/// One of the unknowns, in its table.
struct Unknown {
  std::size_t signal = 0, table = 0;
  TableUnknown change;
};

std::vector<Unknown> listEach(const ModelSpec& model) {
  std::vector<Unknown> all;
  for (const UnknownTable& table : listUnknown(model)) {
    for (const TableUnknown& change : table.changes) {
      all.push_back({table.signal, table.table, change});
    }
  }
  return all;
}

/// The change of a table alone, with as many samples beside as its interpolation reaches.
TableSpec makePulse(const TableSpec& table, const TableUnknown& change, double size) {
  const std::size_t reach = table.interpolation == TableInterpolation::kCubic ? kSplineReach : 1;
  const std::size_t begin = change.first - std::min(change.first, reach);
  const std::size_t end = std::min(table.times.size(), change.first + change.changes.size() + reach);
  TableSpec pulse;
  pulse.interpolation = table.interpolation;
  pulse.measured = table.measured;
  for (std::size_t i = begin; i < end; ++i) {
    const bool changes = i >= change.first && i < change.first + change.changes.size();
    pulse.times.push_back(table.times[i]);
    pulse.values.push_back(changes ? size * change.changes[i - change.first] : 0.0);
  }
  return pulse;
}

/// A model with changes of its tables. Each has an input of its own, behind the others: at 0 it is in its
/// place, at `away` (s) it comes before the simulation.
struct ChangedModel {
  ModelSpec model;
  double away = 0.0;
};

ChangedModel addPulses(const ModelSpec& model, const std::vector<Unknown>& unknowns, double size) {
  ChangedModel changed{model, 0.0};
  for (const Unknown& unknown : unknowns) {
    const TableSpec& table = model.excitation[unknown.signal].tables[unknown.table];
    const double reach = std::abs(table.times.front()) + std::abs(table.times.back());
    changed.away = std::max(changed.away, 2.0 * (reach + model.simulation.duration));
  }
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const TableSpec& table = model.excitation[unknowns[i].signal].tables[unknowns[i].table];
    ParameterSpec input;
    input.name.text = fmt::format("unknown_of_excitation_{}", i);
    input.bounds = {0.0, changed.away, {}};
    input.unit = "s";
    TableSpec pulse = makePulse(table, unknowns[i].change, size);
    const Expression* delay = table.findDelay();
    pulse.measured->delay.text =
        delay == nullptr ? input.name.text : fmt::format("({}) + {}", delay->text, input.name.text);
    changed.model.inputs.push_back(std::move(input));
    changed.model.excitation[unknowns[i].signal].tables.push_back(std::move(pulse));
  }
  return changed;
}

/// A response at each column of points; without one where nothing can be simulated.
std::vector<std::optional<VectorXd>> simulate(const ModelSpec& model, const ResponseLayout& layout,
                                              const MatrixXd& points) {
  const std::unique_ptr<Simulator> simulator =
      shareAmongThreads(makeTrustedSimulator(model, layout.times, layout.modes));
  MatrixXd responses(layout.getRowCount(), points.cols());
  std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
  simulator->simulate(points, responses, statuses.data());
  std::vector<std::optional<VectorXd>> all(statuses.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto response = responses.col(static_cast<Index>(i));
    if (statuses[i].ok && response.allFinite()) {
      all[i] = response;
    }
  }
  return all;
}

/// With each of the unknowns alone changed by `size` standard deviations.
std::vector<std::optional<VectorXd>> simulateChanged(const ModelSpec& model, const ResponseLayout& layout,
                                                     const VectorXd& point,
                                                     const std::vector<Unknown>& unknowns, double size) {
  const ChangedModel changed = addPulses(model, unknowns, size);
  const auto count = static_cast<Index>(unknowns.size());
  MatrixXd points = MatrixXd::Constant(point.size() + count, count, changed.away);
  points.topRows(point.size()).colwise() = point;
  points.bottomRows(count).diagonal().setZero();
  return simulate(changed.model, layout, points);
}

/// The same of a model from elsewhere, which knows no such inputs: one after the other.
std::vector<std::optional<VectorXd>> simulateEachChanged(ModelSpec model, const ResponseLayout& layout,
                                                         const VectorXd& point,
                                                         const std::vector<Unknown>& unknowns, double size) {
  std::vector<std::optional<VectorXd>> all;
  for (const Unknown& unknown : unknowns) {
    std::vector<double>& values = model.excitation[unknown.signal].tables[unknown.table].values;
    const std::vector<double> usual = values;
    addTimes(unknown.change, size, values);
    all.push_back(simulate(model, layout, point).front());
    values = usual;
  }
  return all;
}

}  // namespace

bool hasUnknownExcitation(const ModelSpec& model) {
  for (const UnknownTable& table : listUnknown(model)) {
    if (!table.changes.empty()) {
      return true;
    }
  }
  return false;
}

MatrixXd calcUnknownResponses(const ModelSpec& model, const ResponseLayout& layout, const VectorXd& point) {
  constexpr std::size_t kTogether = 16;  // of which each step looks up the tables of all
  const std::optional<VectorXd> usual = simulate(model, layout, point).front();
  const std::vector<Unknown> unknowns = usual ? listEach(model) : std::vector<Unknown>();
  MatrixXd responses = MatrixXd::Zero(layout.getRowCount(), static_cast<Index>(unknowns.size()));
  for (std::size_t first = 0; first < unknowns.size(); first += kTogether) {
    const std::vector<Unknown> some(
        unknowns.begin() + static_cast<std::ptrdiff_t>(first),
        unknowns.begin() + static_cast<std::ptrdiff_t>(std::min(first + kTogether, unknowns.size())));
    const std::vector<std::optional<VectorXd>> changed =
        model.source ? simulateEachChanged(model, layout, point, some, kImmaterial)
                     : simulateChanged(model, layout, point, some, kImmaterial);
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (changed[i]) {
        responses.col(static_cast<Index>(first + i)) = (*changed[i] - *usual) / kImmaterial;
      }
    }
  }
  return responses;
}

ModelSpec moveUnknown(ModelSpec model, const VectorXd& moves) {
  Index next = 0;
  for (const UnknownTable& unknown : listUnknown(model)) {
    std::vector<double>& own = model.excitation[unknown.signal].tables[unknown.table].values;
    for (const TableUnknown& change : unknown.changes) {
      addTimes(change, moves[next], own);
      ++next;
    }
  }
  return model;
}

std::optional<ModelSpec> supposeNoise(const ModelSpec& model, std::size_t signal, double share,
                                      double& size) {
  ModelSpec supposed = model;
  double squares = 0.0, count = 0.0;
  for (std::size_t s = 0; s < supposed.excitation.size(); ++s) {
    for (TableSpec& table : supposed.excitation[s].tables) {
      table.unknown.clear();
      if (!table.measured) {
        continue;
      }
      if (s == signal && table.measured->noise > 0.0) {
        return std::nullopt;
      }
      table.measured->noise = 0.0;
      if (s == signal) {
        const Eigen::Map<const VectorXd> values(table.values.data(), static_cast<Index>(table.values.size()));
        squares += values.squaredNorm();
        count += static_cast<double>(values.size());
      }
    }
  }
  size = count > 0.0 ? share * std::sqrt(squares / count) : 0.0;
  if (!(size > 0.0)) {
    return std::nullopt;
  }
  for (TableSpec& table : supposed.excitation[signal].tables) {
    if (table.measured) {
      table.measured->noise = size;
    }
  }
  return supposed;
}

std::vector<std::string> describeBridged(const ModelSpec& model) {
  std::vector<std::string> described;
  for (const SignalSpec& signal : model.excitation) {
    for (const TableSpec& table : signal.tables) {
      if (!table.bridged.empty()) {
        described.push_back(fmt::format(
            "{}: {}{}", signal.name.text, table.bridged,
            table.unknown.empty() ? "" : "; what they may have been is in the standard deviations"));
      }
    }
  }
  return described;
}

void cutTable(std::size_t first, std::size_t count, TableSpec& table) {
  const auto take = [&](std::vector<double>& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    values = std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  take(table.times);
  take(table.values);
  std::vector<TableUnknown> within;
  for (const TableUnknown& unknown : table.unknown) {
    const std::size_t end = unknown.first + unknown.changes.size();
    const std::size_t from = std::max(unknown.first, first), to = std::min(end, first + count);
    if (from < to) {
      const auto begin = unknown.changes.begin() - static_cast<std::ptrdiff_t>(unknown.first);
      within.push_back({from - first, std::vector<double>(begin + static_cast<std::ptrdiff_t>(from),
                                                          begin + static_cast<std::ptrdiff_t>(to))});
    }
  }
  table.unknown = std::move(within);
}

}  // namespace twinmap
