#include <memory>
#include <twinmap/build_info.hpp>

#include "framework/c_api/guard.hpp"
#include "framework/c_api/handles.hpp"
#include "framework/c_api/worker_program.hpp"

namespace {

using twinmap::c_api::guard;
using twinmap::c_api::kNaN;
using twinmap::c_api::require;
using twinmap::c_api::WrongArgument;

template <class List>
auto& getItem(List& list, std::size_t index, const char* kind) {
  if (index >= list.size()) {
    throw WrongArgument(std::string(kind) + " " + std::to_string(index) + ": there are " +
                        std::to_string(list.size()));
  }
  return list[index];
}

twinmap_quantity describe(const twinmap::ParameterSpec& parameter) {
  return {parameter.name.text.c_str(), parameter.unit.c_str(), parameter.bounds.lower,
          parameter.bounds.upper};
}

const twinmap::ModelSpec& getModel(const twinmap_map* map) {
  return require(map, "map").source.getExperiment().model;
}

/// What counts is 0 of no map.
template <class Count>
std::size_t count(const twinmap_map* map, const Count& how_many) {
  return map == nullptr ? 0 : static_cast<std::size_t>(how_many(map->source.getReader()));
}

}  // namespace

twinmap_map::twinmap_map(const std::filesystem::path& run_or_experiment) : source(run_or_experiment) {}

const char* twinmap_get_version(void) {
  return twinmap::kVersion;
}

const char* twinmap_get_error(void) {
  return twinmap::c_api::getError();
}

twinmap_result twinmap_open(const char* run_or_maps, twinmap_map** map) {
  return guard([&] {
    require(map, "map") = nullptr;
    twinmap::c_api::chooseWorkerProgram();
    *map = new twinmap_map(&require(run_or_maps, "run_or_maps"));
  });
}

void twinmap_close(twinmap_map* map) {
  delete map;
}

size_t twinmap_count_parameters(const twinmap_map* map) {
  return count(map, [](const auto& reader) { return reader.getExperiment().model.parameters.size(); });
}

size_t twinmap_count_features(const twinmap_map* map) {
  return count(map, [](const auto& reader) { return reader.getExtractor().getFeatureCount(); });
}

size_t twinmap_count_inputs(const twinmap_map* map) {
  return count(map, [](const auto& reader) { return reader.getExperiment().model.inputs.size(); });
}

size_t twinmap_count_outputs(const twinmap_map* map) {
  return count(map, [](const auto& reader) { return reader.getLayout().getOutputCount(); });
}

twinmap_result twinmap_get_parameter(const twinmap_map* map, size_t index, twinmap_quantity* quantity) {
  return guard([&] {
    require(quantity, "quantity") = describe(getItem(getModel(map).parameters, index, "parameter"));
  });
}

twinmap_result twinmap_get_input(const twinmap_map* map, size_t index, twinmap_quantity* quantity) {
  return guard(
      [&] { require(quantity, "quantity") = describe(getItem(getModel(map).inputs, index, "input")); });
}

twinmap_result twinmap_get_feature(const twinmap_map* map, size_t index, twinmap_quantity* quantity) {
  return guard([&] {
    const twinmap::FeatureInfo& info =
        getItem(require(map, "map").source.getReader().getExtractor().getInfos(), index, "feature");
    require(quantity, "quantity") = {info.name.c_str(), info.unit.c_str(), kNaN, kNaN};
  });
}

twinmap_result twinmap_get_output(const twinmap_map* map, size_t index, twinmap_quantity* quantity) {
  return guard([&] {
    const twinmap::ResponseLayout& layout = require(map, "map").source.getReader().getLayout();
    require(quantity, "quantity") = {getItem(layout.output_names, index, "output").c_str(),
                                     layout.output_units[index].c_str(), kNaN, kNaN};
  });
}

twinmap_result twinmap_predict(const twinmap_map* map, const double* features, const double* inputs,
                               size_t rows, int threads, double* mean, double* stddev) {
  return guard([&] {
    if (threads < 1) {
      throw WrongArgument("threads: must be at least 1");
    }
    // row by row for the caller is column by column here
    const auto n = static_cast<Eigen::Index>(rows);
    const auto p = static_cast<Eigen::Index>(getModel(map).parameters.size());
    const auto q = static_cast<Eigen::Index>(getModel(map).inputs.size());
    const double* known = q > 0 ? &require(inputs, "inputs") : nullptr;
    const twinmap::Inferrer* trained = map->source.findTrained();
    if (trained == nullptr) {
      throw WrongArgument("map: an experiment has no map to predict by; infer each measurement");
    }
    const twinmap::Estimates estimates = trained->getMap().predict(
        Eigen::Map<const Eigen::MatrixXd>(&require(features, "features"),
                                          map->source.getReader().getExtractor().getFeatureCount(), n),
        Eigen::Map<const Eigen::MatrixXd>(known, q, q > 0 ? n : 0), threads);
    Eigen::Map<Eigen::MatrixXd>(&require(mean, "mean"), p, n) = estimates.mean;
    Eigen::Map<Eigen::MatrixXd>(&require(stddev, "stddev"), p, n) = estimates.stddev;
  });
}
