#include "framework/diagnosis/held_out.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "framework/base/random/scrambled_sobol.hpp"
#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The machine's parameters are known settings, and what was nuisance is sought.
ExperimentSpec holdParameters(const ExperimentSpec& experiment) {
  ExperimentSpec held = experiment;
  ModelSpec& model = held.model;
  model.inputs = experiment.model.parameters;
  for (ParameterSpec& input : model.inputs) {
    input.prior.reset();
  }
  model.inputs.insert(model.inputs.end(), experiment.model.inputs.begin(), experiment.model.inputs.end());
  model.parameters = experiment.model.nuisance;
  model.nuisance.clear();
  model.priors.clear();
  return held;
}

/// The centre of the box and points all over it: from one alone, an angle may end a turn or a summit away.
MatrixXd makeStarts(const std::vector<ParameterSpec>& unknown) {
  MatrixXd starts = drawSobol(static_cast<int>(unknown.size()), BasinSearchOptions{}.scouts,
                              RandomStream(1, RandomPurpose::kPosterior), 0, 0);
  starts = calcWidths(unknown).asDiagonal() * starts;
  starts.colwise() += calcLowerBounds(unknown);
  starts.col(0) = calcBoxCenter(unknown);
  return starts;
}

/// The unknown parameters of one recording, those of the machine held at `parameters`.
VectorXd fitNuisance(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                     const VectorXd& parameters) {
  const std::vector<ParameterSpec>& nuisance = experiment.model.nuisance;
  VectorXd point(parameters.size() + static_cast<Index>(nuisance.size()));
  point.head(parameters.size()) = parameters;
  if (nuisance.empty()) {
    return point;
  }
  RecordedFeatures held = recording;
  held.known.resize(parameters.size() + recording.known.size());
  held.known << parameters, recording.known;
  const RecordingsProblem problem(holdParameters(experiment), held);
  const RecordingFit fit = problem.fit(addShownStart(problem.get(), makeStarts(nuisance)));
  if (fit.point.size() == 0) {
    throw std::runtime_error("the recording cannot be simulated with these parameters");
  }
  point.tail(static_cast<Index>(nuisance.size())) = fit.point;
  return point;
}

/// Of the residuals of a recording, those that count.
std::vector<Index> listFrom(const std::vector<FeatureInfo>& infos, double from) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].time >= from) {
      rows.push_back(static_cast<Index>(i));
    }
  }
  if (rows.empty()) {
    throw std::runtime_error("the recording has no sample that is to be predicted");
  }
  return rows;
}

double calcRms(const VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

VectorXd calcOutputRms(const VectorXd& residual, const std::vector<FeatureInfo>& infos,
                       const std::vector<Index>& rows, Index outputs) {
  VectorXd squares = VectorXd::Zero(outputs), counts = VectorXd::Zero(outputs);
  for (const Index row : rows) {
    const int output = infos[static_cast<std::size_t>(row)].output;
    if (output >= 0) {
      squares[output] += residual[row] * residual[row];
      counts[output] += 1.0;
    }
  }
  return squares.cwiseQuotient(counts).cwiseSqrt();  // 0/0: NaN
}

/// Of the noise of each output; NaN of those for which none is stated.
VectorXd collectStddevs(const ExperimentSpec& experiment) {
  const std::vector<OutputSpec>& outputs = experiment.model.outputs;
  VectorXd stddevs = VectorXd::Constant(static_cast<Index>(outputs.size()), std::nan(""));
  for (const OutputNoiseSpec& noise : experiment.noise.stddev) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      if (outputs[i].name.text == noise.name.text) {
        stddevs[static_cast<Index>(i)] = experiment.noise.scale * noise.stddev;
      }
    }
  }
  return stddevs;
}

/// chi-square of the residual by the noise and the covariance of the first p columns' parameters; what the
/// others explain, and as many degrees of freedom, is left out.
void setPredictiveTest(const VectorXd& residual, const MatrixXd& jacobian, const KnownMachine& machine,
                       HeldOutPrediction& prediction) {
  const Index p = machine.mean.size(), own = jacobian.cols() - p;
  MatrixXd right(residual.size(), p + 1);
  right << residual, jacobian.leftCols(p);
  if (own > 0) {
    const MatrixXd nuisance = jacobian.rightCols(own);
    const MatrixXd explained = nuisance * linalg::fitLinear(nuisance, right).coefficients;
    right -= explained;
  }
  const VectorXd left = right.col(0);
  const MatrixXd machine_part = right.rightCols(p);
  // (I + J S J')^-1 by Woodbury's identity
  const VectorXd projected = machine_part.transpose() * left;
  const MatrixXd inner =
      linalg::invertPositiveDefinite(machine.covariance) + machine_part.transpose() * machine_part;
  prediction.chi_square =
      left.squaredNorm() -
      projected.dot(VectorXd(linalg::solveCholesky(linalg::calcCholesky(inner).lower, projected)));
  prediction.degrees = static_cast<double>(std::max<Index>(1, residual.size() - own));
  prediction.p_value = boost::math::cdf(boost::math::complement(boost::math::chi_squared(prediction.degrees),
                                                                std::max(0.0, prediction.chi_square)));
}

}  // namespace

ExperimentSpec sizeNoiseByFit(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const SimulatorPosteriorOptions& options) {
  ExperimentSpec sized = experiment;
  if (!hasUnknownNoise(experiment.noise)) {
    return sized;
  }
  const RecordingsProblem problem(experiment, recordings);
  const MatrixXd none(static_cast<Index>(problem.getUnknown().size()), 0);
  const SimulatorPosterior fit = samplePosterior(problem.get(), none, options);
  if (fit.best.size() == 0) {
    throw std::runtime_error(fit.message);
  }
  sized.noise =
      sizeNoise(experiment.noise, {experiment.noise, fit.residual, fit.degrees, problem.listInfos()},
                recordings.listOutputs(experiment));
  return sized;
}

KnownMachine inferMachine(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                          SimulatorPosteriorOptions options) {
  requireKnownNoise(experiment, "how well a prediction must fit");
  options.search.settles = true;
  options.spares_misfit = true;
  const RecordingsProblem problem(experiment, recordings);
  const auto u = static_cast<Index>(problem.getUnknown().size());
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  const SimulatorPosterior posterior = samplePosterior(problem.get(), MatrixXd(u, 0), options);
  if (posterior.best.size() == 0) {
    throw std::runtime_error(posterior.message);
  }
  if (posterior.isReliable()) {
    return {posterior.mean.head(p), posterior.covariance.topLeftCorner(p, p)};
  }
  const VectorXd half_widths = 0.5 * calcWidths(problem.getUnknown());
  const BoundedInformation information(problem.linearize(posterior.best).jacobian, half_widths);
  const MatrixXd covariance =
      half_widths.asDiagonal() * information.calcCovariance() * half_widths.asDiagonal();
  return {posterior.best.head(p), covariance.topLeftCorner(p, p)};
}

KnownMachine stateMachine(const ExperimentSpec& experiment, const VectorXd& parameters) {
  const VectorXd stddevs = kSameNumber * calcWidths(experiment.model.parameters);
  return {parameters, stddevs.cwiseAbs2().asDiagonal()};
}

HeldOutPrediction predictHeldOut(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                                 const KnownMachine& machine, double from) {
  const RecordingsProblem problem(experiment, recording);
  const std::vector<FeatureInfo> infos = problem.listInfos();
  const std::vector<Index> rows = listFrom(infos, from);
  HeldOutPrediction prediction;
  const LinearizedRecordings updated = problem.linearize(fitNuisance(experiment, recording, machine.mean));
  const VectorXd residual = updated.residual(rows);
  prediction.rms = calcRms(residual);
  prediction.output_rms =
      calcOutputRms(updated.residual, infos, rows, static_cast<Index>(experiment.model.outputs.size()));
  prediction.unit_rms = prediction.output_rms.cwiseProduct(collectStddevs(experiment));
  setPredictiveTest(residual, updated.jacobian(rows, Eigen::all), machine, prediction);
  const VectorXd center = calcBoxCenter(experiment.model.parameters);
  const LinearizedRecordings nominal = problem.linearize(fitNuisance(experiment, recording, center));
  prediction.nominal_rms = calcRms(nominal.residual(rows));
  return prediction;
}

}  // namespace twinmap
