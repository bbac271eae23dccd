#pragma once

#include <optional>

#include "framework/models/mechanism/lanes/phases.hpp"
#include "framework/models/mechanism/lanes/rest_program.hpp"
#include "framework/models/mechanism/loops/assembly.hpp"
#include "framework/models/mechanism/model_context.hpp"
#include "kernels/lanes/sample.hpp"

namespace twinmap {

/// Where the samples of a model start, and when their phases begin.
class LaneStart {
 public:
  /// `box_center`: the equilibrium that all samples start from, or empty; `output_times`: s. All must outlive
  /// the object.
  LaneStart(const ModelSpec& spec, const LaneModel& model, const Eigen::VectorXd& box_center,
            const Eigen::VectorXd& output_times);

  /// Fills in parameters, initial states, phases and end of a sample. Throws SimulationFailure for an
  /// equilibrium that is not found.
  void fill(const Eigen::Ref<const Eigen::VectorXd>& parameters, lanes::Sample& sample);

  /// Coordinates, then states of first order, of the sample's own equilibrium.
  Eigen::VectorXd solveEquilibrium(const Eigen::Ref<const Eigen::VectorXd>& parameters);

 private:
  double getOrigin(const Eigen::Ref<const Eigen::VectorXd>& parameters) const {
    return model_.origin_parameter < 0 ? 0.0 : parameters[model_.origin_parameter];
  }
  /// Values of the start program, where what is prescribed is as in the first phase.
  Eigen::VectorXd calcStart(const Eigen::Ref<const Eigen::VectorXd>& parameters);
  void fillInitial(const Eigen::Ref<const Eigen::VectorXd>& parameters, Eigen::MatrixXd states,
                   lanes::Sample& sample);
  /// Where the file's initial coordinates leave loops open, closes them; and rates become speeds.
  void assemble(const Eigen::Ref<const Eigen::VectorXd>& parameters, Eigen::MatrixXd& states);
  /// From an equilibrium on, what is prescribed moves as the file's start `given` says, and with it what
  /// loops tie to it.
  void startPrescribed(const Eigen::MatrixXd& given, Eigen::MatrixXd& states) const;
  /// Rows [coordinates; states of first order] of all states.
  Eigen::MatrixXd takeEquilibrium(const Eigen::MatrixXd& states) const;
  void fillTimes(const SampleTimes& times, lanes::Sample& sample);
  /// [coordinates; speeds; states of first order] with the hidden states.
  Eigen::VectorXd complete(const Eigen::VectorXd& equilibrium) const;

  const ModelSpec& spec_;
  const LaneModel& model_;
  const Eigen::VectorXd &box_center_, &output_times_;
  SingleProgram start_;
  SampleTimes last_times_;     ///< of the sample before
  lanes::Sample last_sample_;  ///< its phases, end and delays
  RestProgram rest_;
  std::optional<Assembly> assembly_;  ///< with loops
};

/// The equilibrium (coordinates, then states of first order) at the box centre that all samples start from;
/// empty if the spec does not ask for it. Throws SimulationFailure if it is not found.
Eigen::VectorXd solveBoxCenter(ModelContext& context, const LaneModel& model);

}  // namespace twinmap
