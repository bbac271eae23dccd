#include "framework/inference/measurement/unknown_excitation.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "framework/models/make_simulator.hpp"

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

std::optional<VectorXd> simulate(const ModelSpec& model, const ResponseLayout& layout,
                                 const VectorXd& point) {
  const std::unique_ptr<Simulator> simulator = makeTrustedSimulator(model, layout.times, layout.modes);
  MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  simulator->simulate(point, response, &status);
  return status.ok && response.allFinite() ? std::make_optional<VectorXd>(response.col(0)) : std::nullopt;
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
  constexpr double kStep = 0.1;  // standard deviations: about a point where responses bend
  const std::optional<VectorXd> usual = simulate(model, layout, point);
  std::vector<VectorXd> columns;
  ModelSpec changed = model;
  for (const UnknownTable& unknown : listUnknown(model)) {
    const std::vector<double> values = model.excitation[unknown.signal].tables[unknown.table].values;
    std::vector<double>& own = changed.excitation[unknown.signal].tables[unknown.table].values;
    for (const TableUnknown& change : unknown.changes) {
      addTimes(change, kStep, own);
      const std::optional<VectorXd> response = usual ? simulate(changed, layout, point) : std::nullopt;
      columns.emplace_back(response ? VectorXd((*response - *usual) / kStep)
                                    : VectorXd(VectorXd::Zero(layout.getRowCount())));
      own = values;
    }
  }
  MatrixXd responses(layout.getRowCount(), usual ? static_cast<Index>(columns.size()) : 0);
  for (Index i = 0; i < responses.cols(); ++i) {
    responses.col(i) = columns[static_cast<std::size_t>(i)];
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

}  // namespace twinmap
