#include <cmath>
#include <memory>

#include "framework/c_api/guard.hpp"
#include "framework/c_api/handles.hpp"
#include "framework/data/measurement/files/make_table.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/select_estimate.hpp"

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using twinmap::c_api::guard;
using twinmap::c_api::require;
using twinmap::c_api::requireCount;
using twinmap::c_api::WrongArgument;
using ConstVector = Eigen::Map<const VectorXd>;

std::optional<bool> toChoice(twinmap_refine refine) {
  switch (refine) {
    case TWINMAP_REFINE_NEVER:
      return false;
    case TWINMAP_REFINE_ALWAYS:
      return true;
    case TWINMAP_REFINE_AS_EXPERIMENT:
      return std::nullopt;
  }
  throw WrongArgument("refine: " + std::to_string(refine) + " is none of its values");
}

twinmap::SessionOptions makeOptions(std::optional<bool> refine, twinmap_posterior posterior, int draws) {
  const int asked = draws != 0 ? draws : twinmap::kDefaultPosteriorDraws;
  switch (posterior) {
    case TWINMAP_POSTERIOR_AS_NEEDED:
      return {refine, 0, {}};
    case TWINMAP_POSTERIOR_AUTOMATIC:
      return {refine, asked, {}};
    case TWINMAP_POSTERIOR_SIMULATOR:
      return {refine, asked, twinmap::PosteriorSource::kSimulator};
    case TWINMAP_POSTERIOR_SURROGATE:
      return {refine, asked, twinmap::PosteriorSource::kSurrogate};
  }
  throw WrongArgument("posterior: " + std::to_string(posterior) + " is none of its values");
}

const VectorXd& getKnown(twinmap_inferrer& inferrer) {
  if (!inferrer.known) {  // says which are missing
    inferrer.known = twinmap::collectKnown(inferrer.source.getExperiment().model.inputs, {});
  }
  return *inferrer.known;
}

/// Infers by `infer`, which takes the known inputs; what was inferred before is forgotten.
template <class Infer>
twinmap_result inferBy(twinmap_inferrer* inferrer, const Infer& infer) {
  return guard([&] {
    twinmap_inferrer& self = require(inferrer, "inferrer");
    self.inferred.reset();
    twinmap::InferredMeasurement measurement = infer(self, getKnown(self));
    twinmap::Estimate estimate = twinmap::selectEstimate(measurement);
    self.inferred = {std::move(measurement), std::move(estimate)};
  });
}

twinmap::Table makeTable(const twinmap_inferrer& inferrer, const std::vector<twinmap::NamedColumn>& columns) {
  return twinmap::makeTable("measurement", columns, inferrer.source.getReader().listColumns(),
                            inferrer.session->getMissingCells());
}

/// As the command does.
twinmap::InferredMeasurement inferAndTest(twinmap_inferrer& inferrer, const VectorXd& known,
                                          const twinmap::Table& table) {
  twinmap::InferredMeasurement measurement = inferrer.session->infer(table, inferrer.start, known);
  twinmap::testModel(inferrer.source.getReader(), table, inferrer.start, known, measurement);
  return measurement;
}

}  // namespace

twinmap_result twinmap_new_inferrer(const twinmap_map* map, twinmap_refine refine,
                                    twinmap_inferrer** inferrer) {
  return twinmap_new_posterior_inferrer(map, refine, TWINMAP_POSTERIOR_AS_NEEDED, 0, inferrer);
}

twinmap_result twinmap_new_posterior_inferrer(const twinmap_map* map, twinmap_refine refine,
                                              twinmap_posterior posterior, int draws,
                                              twinmap_inferrer** inferrer) {
  return guard([&] {
    require(inferrer, "inferrer") = nullptr;
    *inferrer =
        new twinmap_inferrer(require(map, "map").source, makeOptions(toChoice(refine), posterior, draws));
  });
}

void twinmap_close_inferrer(twinmap_inferrer* inferrer) {
  delete inferrer;
}

twinmap_result twinmap_set_inputs(twinmap_inferrer* inferrer, const double* values, size_t count) {
  return guard([&] {
    const std::vector<twinmap::ParameterSpec>& inputs =
        require(inferrer, "inferrer").source.getExperiment().model.inputs;
    requireCount(count, inputs.size(), "values");
    std::vector<twinmap::KnownValue> known;
    for (std::size_t i = 0; i < count; ++i) {
      known.push_back({inputs[i].name.text, (&require(values, "values"))[i]});
    }
    inferrer->known = twinmap::collectKnown(inputs, known);
  });
}

twinmap_result twinmap_set_start(twinmap_inferrer* inferrer, double start) {
  return guard([&] {
    if (!std::isfinite(start)) {
      throw WrongArgument("start: must be a finite time");
    }
    require(inferrer, "inferrer").start = start;
  });
}

twinmap_result twinmap_infer_features(twinmap_inferrer* inferrer, const double* features, size_t count) {
  return inferBy(inferrer, [&](twinmap_inferrer& self, const VectorXd& known) {
    requireCount(count, static_cast<std::size_t>(self.source.getReader().getExtractor().getFeatureCount()),
                 "features");
    const ConstVector values(&require(features, "features"), static_cast<Index>(count));
    if (!values.allFinite()) {
      throw WrongArgument("features: must be finite numbers");
    }
    return self.session->infer(VectorXd(values), known);
  });
}

twinmap_result twinmap_infer_columns(twinmap_inferrer* inferrer, const twinmap_column* columns,
                                     size_t count) {
  return inferBy(inferrer, [&](twinmap_inferrer& self, const VectorXd& known) {
    std::vector<twinmap::NamedColumn> named;
    for (std::size_t i = 0; i < count; ++i) {
      const twinmap_column& column = (&require(columns, "columns"))[i];
      named.push_back({&require(column.name, "name of a column"),
                       ConstVector(column.count > 0 ? &require(column.values, column.name) : nullptr,
                                   static_cast<Index>(column.count))});
    }
    return inferAndTest(self, known, makeTable(self, named));
  });
}

twinmap_result twinmap_infer_file(twinmap_inferrer* inferrer, const char* path) {
  return inferBy(inferrer, [&](twinmap_inferrer& self, const VectorXd& known) {
    const twinmap::Table table = twinmap::readTable(
        &require(path, "path"), self.source.getReader().listColumns(), self.session->getMissingCells());
    return inferAndTest(self, known, table);
  });
}

twinmap_result twinmap_begin(twinmap_inferrer* inferrer, const char* const* names, size_t count) {
  return guard([&] {
    twinmap_inferrer::Pushed& pushed = require(inferrer, "inferrer").pushed;
    pushed.names.clear();
    for (std::size_t i = 0; i < count; ++i) {
      pushed.names.emplace_back(&require((&require(names, "names"))[i], "name of a column"));
    }
    pushed.values.resize(count);
    for (std::vector<double>& column : pushed.values) {
      column.clear();
    }
  });
}

twinmap_result twinmap_push(twinmap_inferrer* inferrer, const double* values, size_t count) {
  return guard([&] {
    twinmap_inferrer::Pushed& pushed = require(inferrer, "inferrer").pushed;
    requireCount(count, pushed.names.size(), "values");
    for (std::size_t i = 0; i < count; ++i) {
      pushed.values[i].push_back((&require(values, "values"))[i]);
    }
  });
}

twinmap_result twinmap_infer_pushed(twinmap_inferrer* inferrer) {
  return inferBy(inferrer, [](twinmap_inferrer& self, const VectorXd& known) {
    std::vector<twinmap::NamedColumn> named;
    for (std::size_t i = 0; i < self.pushed.names.size(); ++i) {
      const std::vector<double>& values = self.pushed.values[i];
      named.push_back({self.pushed.names[i], ConstVector(values.data(), static_cast<Index>(values.size()))});
    }
    return self.session->infer(makeTable(self, named), self.start, known);  // online: its time counts
  });
}
