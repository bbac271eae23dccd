#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// What is known of a machine's parameters: normal.
struct KnownMachine {
  Eigen::VectorXd mean;        ///< p
  Eigen::MatrixXd covariance;  ///< p x p
};

/// The experiment with noise of unknown size as large as the residual that its best fit leaves of recordings:
/// what is predicted with it is held to what was fitted. Throws as inferMachine() does. Cost: its cost.
ExperimentSpec sizeNoiseByFit(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const SimulatorPosteriorOptions& options);

/// From recordings, by their posterior. By the linear model at its best point where no posterior is reliable,
/// or noise does not explain that. Throws std::runtime_error where nothing can be simulated.
/// Cost: that of samplePosterior().
KnownMachine inferMachine(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                          SimulatorPosteriorOptions options);

/// As others state them: exact, up to a millionth of the bounds.
KnownMachine stateMachine(const ExperimentSpec& experiment, const Eigen::VectorXd& parameters);

/// How well a model predicts a recording that it has not seen. Residuals are in noise standard deviations.
struct HeldOutPrediction {
  double rms = 0.0;            ///< of the updated model
  double nominal_rms = 0.0;    ///< of the model at the centre of the bounds
  Eigen::VectorXd output_rms;  ///< of each output; NaN of one without samples
  Eigen::VectorXd unit_rms;  ///< the same in the output's unit; NaN where its noise has no standard deviation
  double chi_square = 0.0;  ///< of what the noise and the parameters' covariance should leave of the residual
  double degrees = 0.0;
  double p_value = 1.0;
};

/// What is unknown of the recording alone (nuisance parameters, as its initial state) is fitted to it, for
/// either model alike; the machine's parameters are held. Samples before `from` (s) count for these alone,
/// for nothing else. Throws std::runtime_error where the recording cannot be simulated or has no sample from
/// there on. Cost: two fits of the nuisance parameters and two simulations with derivatives.
HeldOutPrediction predictHeldOut(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                                 const KnownMachine& machine, double from = -1.0);

}  // namespace twinmap
