#include "framework/export/json_export.hpp"

#include <cmath>
#include <stdexcept>

#include "framework/base/json/json.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "kernels/gp/online/process_view.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double requireFinite(double value) {
  if (!std::isfinite(value)) {
    throw std::runtime_error("a number of the map is not finite");
  }
  return value;
}

Json toJson(const Eigen::Ref<const VectorXd>& values) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(requireFinite(value));
  }
  return list;
}

/// A list of rows.
Json toRows(const MatrixXd& matrix) {
  Json rows = Json::array();
  for (Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(toJson(matrix.row(i).transpose()));
  }
  return rows;
}

Json toJson(const std::vector<ParameterSpec>& parameters) {
  Json list = Json::array();
  for (const ParameterSpec& parameter : parameters) {
    list.push_back({{"name", parameter.name.text},
                    {"unit", parameter.unit},
                    {"lower", parameter.bounds.lower},
                    {"upper", parameter.bounds.upper}});
  }
  return list;
}

Json toJson(const std::vector<FeatureInfo>& features) {
  Json list = Json::array();
  for (const FeatureInfo& info : features) {
    list.push_back({{"name", info.name}, {"unit", info.unit}});
  }
  return list;
}

Json makeSignals(const ResponseLayout& layout) {
  Json list = Json::array();
  for (std::size_t i = 0; i < layout.output_names.size(); ++i) {
    list.push_back({{"name", layout.output_names[i]}, {"unit", layout.output_units[i]}});
  }
  return list;
}

/// Where features are linear in the response: row, column and value of each entry; else null.
Json makeFeatureMatrix(const ExportedModel& model) {
  const FeatureExtractor extractor = makeExtractor(model.experiment, model.layout);
  if (!extractor.isLinear()) {
    return nullptr;
  }
  Json rows = Json::array(), columns = Json::array(), values = Json::array();
  Index first = 0;
  for (const auto& block : extractor.getBlocks()) {
    const FeatureMatrix& matrix = *block->findMatrix();
    for (Index row = 0; row < matrix.rows(); ++row) {
      for (FeatureMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
        rows.push_back(first + row);
        columns.push_back(entry.col());
        values.push_back(requireFinite(entry.value()));
      }
    }
    first += matrix.rows();
  }
  return {{"rows", rows}, {"columns", columns}, {"values", values}};
}

Json toJson(const gp::Process& process) {
  const gp::ProcessView view = gp::viewProcess(process);
  const gp::Hyperparameters& h = view.hyperparameters;
  Json json{{"covariance", gp::toString(view.structure.covariance)},
            {"signal_stddev", requireFinite(h.signal_stddev)},
            {"noise_stddev", requireFinite(h.noise_stddev)},
            {"shape", requireFinite(h.shape)},
            {"linear_stddev", view.structure.linear_term ? requireFinite(h.linear_stddev) : 0.0}};
  json["length_scales"] = toJson(view.mean.getInverseLengthScales().cwiseInverse());
  json["center"] = toJson(view.mean.getCenter());
  json["inputs"] = toRows(view.inputs.transpose());
  json["weights"] = toJson(view.weights);
  json["factor"] = toRows(view.factor);
  json["correction"] = view.correction != nullptr ? toRows(*view.correction) : Json();
  json["mean_coefficients"] = toJson(view.mean_coefficients);
  json["whitened_basis"] = toRows(view.whitened_basis);
  json["basis_factor"] = toRows(view.basis_factor);
  return json;
}

Json toJson(const GpMap& map) {
  const MatrixXd matrix = map.transform.calcMatrix();
  Json json{{"kind", "processes"}};
  json["transform"] = {{"offset", toJson(VectorXd(map.transform.apply(VectorXd::Zero(matrix.cols()))))},
                       {"matrix", toRows(matrix)}};
  json["known_inputs"] = {{"center", toJson(map.known_inputs.center)},
                          {"half_width", toJson(map.known_inputs.half_width)}};
  json["target"] = {{"offset", toJson(map.target_offset)}, {"scale", toJson(map.target_scale)}};
  json["noise"] = {{"directions", toRows(map.noise.directions)},
                   {"mean_of_slope", toJson(map.noise.mean_of_slope)},
                   {"smallest_factor", NoiseProfile::kSmallestFactor}};
  json["processes"] = Json::array();
  for (const gp::Process& process : map.processes) {
    json["processes"].push_back(toJson(process));
  }
  return json;
}

Json toJson(const gp::SharedProcess& process) {
  const gp::SharedProcessParts parts = process.getParts();
  const bool exponential = parts.structure.covariance == gp::SmoothCovariance::kSquaredExponential;
  Json json{{"covariance", exponential ? "squared_exponential" : "matern52"},
            {"trend", parts.structure.trend == gp::Trend::kQuadratic ? "quadratic" : "linear"},
            {"nugget", requireFinite(parts.hyperparameters.nugget)},
            {"slope_points", parts.slope_points},
            {"slope_variables", parts.slope_variables}};
  json["length_scales"] = toJson(parts.hyperparameters.length_scales);
  json["scaled_points"] = toRows(parts.scaled_points);
  json["weights"] = toRows(parts.weights);
  json["coefficients"] = toRows(parts.coefficients);
  json["amplitudes"] = toJson(parts.amplitude);
  json["left_out_ratios"] = toJson(parts.left_out_ratio);
  return json;
}

Json toJson(const ForwardSurrogate& forward) {
  Json json{{"center", toJson(forward.center)}, {"projection", toRows(forward.projection)}};
  json["points"] = toRows(forward.points.transpose());
  json["scores"] = toRows(forward.scores.transpose());
  json["error_correlation"] = toRows(forward.error_correlation);
  json["error_variance"] = toJson(forward.error_variance);
  json["windows"] = Json::array();
  for (const gp::SharedProcess& process : forward.windows) {
    json["windows"].push_back(toJson(process));
  }
  return json;
}

Json toJson(const NetworkMap& map) {
  const network::Network& network = map.members.front().network;
  Json json{{"kind", "network"}};
  json["inputs"] = {{"center", toJson(map.inputs.center)}, {"projection", toRows(map.inputs.projection)}};
  json["known_inputs"] = {{"center", toJson(map.inputs.known.center)},
                          {"half_width", toJson(map.inputs.known.half_width)}};
  json["regression"] = {{"offset", toJson(network.offset)},
                        {"slopes", toRows(network.skip)},
                        {"squared", network.products.squared},
                        {"cubed", network.products.cubed}};
  json["scale"] = toJson(network.scale);
  json["layers"] = Json::array();
  for (const network::Layer& layer : network.layers) {
    json["layers"].push_back({{"weights", toRows(layer.weights)}, {"biases", toJson(layer.biases)}});
  }
  json["target"] = {{"offset", toJson(map.center)}, {"scale", toJson(map.half_width)}};
  json["stddev_scale"] = toJson(map.validation.stddev_scale);
  json["status"] = toString(map.validation.status);
  return json;
}

Json makeMap(const ExportedModel& model) {
  if (const GpMap* processes = model.findProcesses()) {
    return toJson(*processes);
  }
  if (const NetworkMap* network = model.findNetwork()) {
    return toJson(*network);
  }
  const Surrogate* surrogate = model.findSurrogate();
  return {{"kind", "surrogate"},
          {"stddev_scale", toJson(surrogate->validation.stddev_scale)},
          {"limit_scale", toJson(surrogate->validation.limit_scale)},
          {"status", toString(surrogate->validation.status)}};
}

Json toJson(const TrustModel& trust) {
  Json runs = Json::array();
  for (const ResidualRun& run : trust.runs) {
    runs.push_back({run.first, run.count});
  }
  Json json{{"level", trust.level}, {"runs", runs}};
  json["whitener"] = toRows(trust.space.whitener);
  json["directions"] = toRows(trust.space.directions);
  json["unmodelled"] = toRows(trust.space.unmodelled);
  json["unmodelled_stddev"] = toJson(trust.space.unmodelled_stddev);
  json["chi_square"] = toJson(trust.chi_square.sorted);
  json["anomaly"] = toJson(trust.anomaly.sorted);
  json["cloud"] = {{"inputs", toRows(trust.cloud.inputs.transpose())},
                   {"scale", toJson(trust.cloud.scale)},
                   {"reach", trust.cloud.reach}};
  return json;
}

}  // namespace

std::string makeMapJson(const ExportedModel& model) {
  Json json{{"format", "twinmap map"}, {"version", 1}, {"name", model.experiment.name.text}};
  json["parameters"] = toJson(model.experiment.model.parameters);
  json["known_inputs"] = toJson(model.experiment.model.inputs);
  json["signals"] = makeSignals(model.layout);
  json["grid"] = toJson(model.layout.times);
  json["features"] = toJson(model.features);
  json["feature_matrix"] = makeFeatureMatrix(model);
  json["box"] = {{"center", toJson(model.getBoxCenter())},
                 {"half_width", toJson(model.getBoxHalfWidth())},
                 {"unknown", model.countUnknown()}};
  json["correlation"] = toRows(model.getCorrelation());
  json["interval_factor"] = toJson(model.getIntervalFactors());
  json["map"] = makeMap(model);
  const ForwardSurrogate* forward = model.findForward();
  json["surrogate"] = forward != nullptr ? toJson(*forward) : Json();
  json["trust"] = model.online.trust ? toJson(*model.online.trust) : Json();
  return formatJson(json) + "\n";
}

}  // namespace twinmap
