// The module that twinmap loads where it needs Simbody: what makeSimbodyModel() looks for.

#include <optional>

#include "framework/models/mechanism/simbody/box_center.hpp"
#include "framework/models/mechanism/simbody/initial_state.hpp"
#include "framework/models/mechanism/simbody/outputs.hpp"
#include "framework/models/mechanism/simbody/simbody_engine.hpp"
#include "framework/models/mechanism/simbody_model.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;

/// Simbody's exceptions stay within the module.
template <typename Action>
auto translateFailures(const Action& action) {
  try {
    return action();
  } catch (const SimTK::Exception::Base& error) {
    throw SimulationFailure(std::string("Simbody: ") + error.getMessage());
  }
}

class LoadedModel final : public SimbodyModel {
 public:
  explicit LoadedModel(const ModelSpec& model) : context_(model) { buildAtBoxCenter(context_); }

  VectorXd solveBoxCenter() override { return twinmap::solveBoxCenter(context_); }
  void checkStart(const VectorXd& box_center) override { checkStartAtBoxCenter(context_, box_center); }

  void setParameters(const VectorXd& point) override {
    translateFailures([&] {
      context_.numbers.update(point);
      system_.emplace(context_, true);
      outputs_.emplace(context_.model.outputs, context_.names, context_.numbers);
    });
  }

  SimbodyMotion calcMotion(const InitialState& at, double t, double phase_begin) override {
    return translateFailures([&] {
      const BodyTree& tree = system_.value().getTree();
      SimTK::State state = tree.getDefaultState();
      setState(*system_, at, state);
      context_.excitation.mute();
      context_.excitation.beginPhase(phase_begin);
      state.setTime(t);
      tree.getSystem().realize(state, SimTK::Stage::Acceleration);
      SimbodyMotion motion;
      const auto n = static_cast<Eigen::Index>(tree.getSlots().size());
      motion.speeds =
          VectorXd::NullaryExpr(n, [&](Eigen::Index i) { return state.getU()[tree.getSlots()[i].u]; });
      motion.accelerations =
          VectorXd::NullaryExpr(n, [&](Eigen::Index i) { return state.getUDot()[tree.getSlots()[i].u]; });
      system_->calcForces(state, t);
      const std::vector<double>& rates = system_->getStateRates();
      motion.state_rates = Eigen::Map<const VectorXd>(rates.data(), static_cast<Eigen::Index>(rates.size()));
      motion.outputs.resize(static_cast<Eigen::Index>(context_.model.outputs.size()));
      outputs_->calc(*system_, state, t, motion.outputs.data(), 1);
      return motion;
    });
  }

  SampleStatus simulate(const SampleTask& task, const Eigen::Ref<const VectorXd>& parameters,
                        Eigen::Ref<VectorXd> response, StepSequence& sequence) override {
    return SimbodyEngine(context_, task).simulate(parameters, response, sequence);
  }

 private:
  SimbodyContext context_;
  std::optional<LoadedSystem> system_;  ///< of setParameters()
  std::optional<Outputs> outputs_;
};

}  // namespace
}  // namespace twinmap

extern "C" __attribute__((visibility("default"))) twinmap::SimbodyModel* twinmap_make_simbody_model(
    const twinmap::ModelSpec& model) {
  return std::make_unique<twinmap::LoadedModel>(model).release();
}
