#include <fmt/core.h>

#include <algorithm>

#include "framework/export/c_code/c_model_tables.hpp"
#include "kernels/gp/online/process_view.hpp"
#include "kernels/linalg/packed_lower.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBatch = 4;  // as BATCH of runtime/processes.c
constexpr const char* kCovariances[] = {"SQUARED_EXPONENTIAL", "MATERN_32", "MATERN_52",
                                        "RATIONAL_QUADRATIC"};
constexpr Index kChunk = linalg::PackedSamples::kChunk;

Index countChunks(Index inputs) {
  return (inputs + kChunk - 1) / kChunk;
}

VectorXd padRows(const MatrixXd& matrix) {
  MatrixXd padded = MatrixXd::Zero(countChunks(matrix.rows()) * kChunk, matrix.cols());
  padded.topRows(matrix.rows()) = matrix;
  return flattenColumns(padded);
}

/// Parameters [first, first + count) that share their inputs.
std::string addBatch(const std::vector<gp::ProcessView>& views, Index first, Index count, CTables& tables) {
  const gp::ProcessView& view = views[static_cast<std::size_t>(first)];
  const VectorXd& center = view.mean.getCenter();
  MatrixXd weights = MatrixXd::Zero(count == 1 ? 1 : kBatch, center.size());
  for (Index t = 0; t < count; ++t) {
    const gp::ProcessView& of = views[static_cast<std::size_t>(first + t)];
    weights.row(t) = of.mean.getInverseLengthScales().cwiseAbs2().transpose();
  }
  const std::string name = fmt::format("batch_{}", first);
  tables.addWide(name + "_center", center, "Mean training input of the process.");
  tables.addWide(name + "_inputs", linalg::PackedSamples(view.inputs.colwise() - center).getValues(),
                 fmt::format("Inputs of the processes less their mean: {} of {} numbers, in chunks of {}, "
                             "feature by feature.",
                             view.inputs.cols(), view.inputs.rows(), kChunk));
  tables.addWide(name + "_inverse_square", flattenColumns(weights),
                 "1 / squared length scale: of each feature that of each parameter.");
  return fmt::format("{0}, {1}, {2}, {3}_center, {3}_inputs, {3}_inverse_square", first, count,
                     countChunks(view.inputs.cols()), name);
}

std::string addProcess(const gp::ProcessView& view, Index parameter, double mean_slope, CTables& tables) {
  const gp::Hyperparameters& h = view.hyperparameters;
  const std::string name = fmt::format("process_{}", parameter);
  const Index n = view.inputs.cols(), chunks = countChunks(n), coefficients = view.mean_coefficients.size();
  tables.addWide(
      name + "_weights", padRows(view.weights),
      fmt::format("Weights of {} covariances, standardised parameter; zeros up to whole chunks.", n));
  tables.addWide(name + "_factor", linalg::PackedLower(linalg::viewOf(view.factor)).getTiles(),
                 "Lower factor of the inputs' covariance, in tiles; those on the diagonal inverted.");
  if (view.correction != nullptr) {
    tables.addWide(name + "_correction", linalg::PackedLower(linalg::viewOf(*view.correction)).getTiles(),
                   "Lower factor of what the samples say of the inducing inputs, in tiles.");
  }
  if (coefficients > 0) {
    tables.addWide(name + "_basis", padRows(view.whitened_basis), "The mean function's terms, whitened.");
    tables.addWide(name + "_basis_factor", flattenRows(view.basis_factor),
                   "Lower factor of their information, row by row.");
    tables.addWide(name + "_coefficients", view.mean_coefficients, "Coefficients of the mean function.");
  }
  tables.addWide(name + "_gradient", view.calcConstantGradient(),
                 "The part of the mean's gradient that is the same everywhere.");
  const double linear = view.structure.linear_term ? h.linear_stddev * h.linear_stddev : 0.0;
  const std::string basis = coefficients > 0
                                ? fmt::format("{0}_basis, {0}_basis_factor, {0}_coefficients", name)
                                : std::string("0, 0, 0");
  return fmt::format("{}, {}, {}, {}, {}, {}, {}, {},\n   {}_weights, {}_factor, {}, {}, {}_gradient, {}",
                     kCovariances[static_cast<int>(view.structure.covariance)], n, chunks, coefficients,
                     toC(h.signal_stddev * h.signal_stddev), toC(h.shape), toC(linear),
                     toC(h.noise_stddev * h.noise_stddev), name, name,
                     view.correction != nullptr ? name + "_correction" : "0", basis, name, toC(mean_slope));
}

/// Targets and the noise's profile, as both forms of processes have them.
void addTargets(const GpMap& map, CTables& tables, CSizes& sizes) {
  const bool constant = map.noise.isConstant();
  tables.addWide("target_offset", map.target_offset, "Mean of the training parameters, in their units.");
  tables.addWide("target_scale", map.target_scale, "Their standard deviation, in their units.");
  if (!constant) {
    tables.addWide("noise_directions", flattenColumns(map.noise.directions),
                   "Square root of the inputs' noise covariance, column by column.");
    tables.addNumber("smallest_noise_factor", NoiseProfile::kSmallestFactor,
                     "Where the map is flat, its noise is at least this share of the mean.");
  }
  sizes.push_back({"DIRECTIONS", constant ? 0 : static_cast<long>(map.noise.directions.cols()),
                   "of the inputs' noise; 0: the noise of a parameter is constant"});
}

std::string addCompressedProcess(const gp::Process& process, Index parameter, double mean_slope,
                                 CTables& tables) {
  const auto& sparse = *std::get<std::shared_ptr<const gp::SparseGaussianProcess>>(process);
  const gp::SparseGaussianProcessParts& parts = sparse.getParts();
  const gp::VariationalPosterior& posterior = parts.posterior;
  const gp::ProcessView view = gp::viewProcess(process);
  const gp::Hyperparameters& h = parts.hyperparameters;
  const std::string name = fmt::format("process_{}", parameter);
  const Index coefficients = posterior.mean_coefficients.size();
  tables.addWide(name + "_center", parts.center, "Mean training input of the process.");
  tables.addWide(name + "_inverse_square", view.mean.getInverseLengthScales().cwiseAbs2(),
                 "1 / squared length scale of each input.");
  tables.addReal(name + "_points", flattenColumns(parts.inducing),
                 fmt::format("{} points that stand for the training inputs.", parts.inducing.cols()));
  tables.addWide(name + "_weights",
                 posterior.inducing_factor.triangularView<Eigen::Lower>().transpose() * posterior.weights,
                 "Weights of their whitened covariances, standardised parameter.");
  tables.addReal(name + "_correction", linalg::packColumns(posterior.correction_factor),
                 "Lower factor of what the samples say of the points, column by column.");
  if (coefficients > 0) {
    tables.addWide(name + "_basis", flattenColumns(view.whitened_basis),
                   "The mean function's terms, whitened.");
    tables.addWide(name + "_basis_factor", flattenRows(view.basis_factor),
                   "Lower factor of their information, row by row.");
    tables.addWide(name + "_coefficients", view.mean_coefficients, "Coefficients of the mean function.");
  }
  tables.addWide(name + "_gradient", view.calcConstantGradient(),
                 "The part of the mean's gradient that is the same everywhere.");
  return fmt::format(
      "{}, {}, {}, {}, {}, {}, {},\n   {}_center, {}_inverse_square, {}_points, {}_weights, "
      "{}_correction, {}, {}_gradient, {}",
      kCovariances[static_cast<int>(parts.structure.covariance)], parts.inducing.cols(), coefficients,
      toC(h.signal_stddev * h.signal_stddev), toC(h.shape), toC(h.noise_stddev * h.noise_stddev),
      toC(posterior.jitter), name, name, name, name, name,
      coefficients > 0 ? fmt::format("{0}_basis, {0}_basis_factor, {0}_coefficients", name) : "0, 0, 0", name,
      toC(mean_slope));
}

}  // namespace

void addCompressedProcesses(const GpMap& map, CTables& tables, CSizes& sizes) {
  std::vector<std::string> processes;
  Index largest = 0, coefficients = 0;
  for (const gp::Process& process : map.processes) {
    const auto p = static_cast<Index>(processes.size());
    const gp::ProcessView view = gp::viewProcess(process);
    largest = std::max(largest, view.inputs.cols());
    coefficients = std::max(coefficients, view.mean_coefficients.size());
    processes.push_back(
        addCompressedProcess(process, p, map.noise.isConstant() ? 0.0 : map.noise.mean_of_slope[p], tables));
  }
  tables.addStructs("process", "processes", processes, "The process of each parameter.");
  addTargets(map, tables, sizes);
  sizes.push_back({"LARGEST", static_cast<long>(largest), "most points of a process"});
  sizes.push_back({"COEFFICIENTS", static_cast<long>(coefficients), "most coefficients of a mean function"});
}

void addTransform(const GpMap& map, bool compressed, CTables& tables, CSizes& sizes) {
  const MatrixXd matrix = map.transform.calcMatrix();
  const VectorXd center =
      compressed ? map.transform.steps.front().offset : VectorXd(VectorXd::Zero(matrix.cols()));
  const bool diagonal = !compressed && matrix.rows() == matrix.cols() && matrix.isDiagonal(0.0);
  tables.addWide("transform_offset", map.transform.apply(center),
                 compressed ? "Inputs of the processes at the middle features."
                            : "Inputs of the processes where all features are 0.");
  const VectorXd entries = diagonal ? VectorXd(matrix.diagonal()) : flattenColumns(matrix);
  const std::string meaning =
      diagonal ? "Inputs per unit of their feature."
               : fmt::format("Inputs per unit of the features, {} x {}, feature by feature.", matrix.rows(),
                             matrix.cols());
  if (compressed) {
    tables.addReal("transform_center", center, "The middle features, in their units.");
    tables.addReal("transform_matrix", entries, meaning);
  } else {
    tables.addWide("transform_matrix", entries, meaning);
  }
  if (map.known_inputs.center.size() > 0) {
    tables.addWide("known_center", map.known_inputs.center,
                   "Middle of the known inputs' bounds, in their units.");
    tables.addWide("known_half_width", map.known_inputs.half_width, "Half of their width.");
  }
  sizes.push_back({"INPUTS", static_cast<long>(matrix.rows()), "inputs of the map, made of features"});
  sizes.push_back({"DIAGONAL", diagonal ? 1 : 0, "1: each input is made of one feature"});
}

void addProcesses(const GpMap& map, CTables& tables, CSizes& sizes) {
  std::vector<gp::ProcessView> views;
  Index largest = 0, coefficients = 0;
  for (const gp::Process& process : map.processes) {
    views.push_back(gp::viewProcess(process));
    largest = std::max(largest, countChunks(views.back().inputs.cols()) * kChunk);
    coefficients = std::max(coefficients, views.back().mean_coefficients.size());
  }
  const auto total = static_cast<Index>(views.size());
  std::vector<std::string> batches, processes;
  for (Index first = 0, count = 1; first < total; first += count) {
    for (count = 1; count < kBatch && first + count < total; ++count) {
      if (!views[static_cast<std::size_t>(first)].sharesInputs(
              views[static_cast<std::size_t>(first + count)])) {
        break;
      }
    }
    batches.push_back(addBatch(views, first, count, tables));
  }
  const bool constant = map.noise.isConstant();
  for (Index p = 0; p < total; ++p) {
    processes.push_back(addProcess(views[static_cast<std::size_t>(p)], p,
                                   constant ? 0.0 : map.noise.mean_of_slope[p], tables));
  }
  tables.addStructs("process_batch", "process_batches", batches,
                    "Parameters whose processes share their inputs.");
  tables.addStructs("process", "processes", processes, "The process of each parameter.");
  addTargets(map, tables, sizes);
  sizes.push_back({"LARGEST", static_cast<long>(largest), "most inputs of a process, whole chunks"});
  sizes.push_back({"COEFFICIENTS", static_cast<long>(coefficients), "most coefficients of a mean function"});
  sizes.push_back({"BATCHES", static_cast<long>(batches.size()), "groups of processes that share inputs"});
}

}  // namespace twinmap
