#include "framework/models/mechanism/lanes/lane_programs.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/lanes/compare_with_simbody.hpp"
#include "framework/models/mechanism/lanes/motion_checks.hpp"
#include "framework/models/mechanism/loops/make_loop_model.hpp"
#include "framework/models/mechanism/sampled_keys.hpp"

namespace twinmap {
namespace {

/// Why the model cannot be simulated in lanes whatever its equations are, or "".
std::string findObstacle(const ModelContext& context) {
  if (context.model.simulation.engine == Engine::kSimbody) {
    return "simulation.engine asks for it";
  }
  return context.names.getCoordinateNames().empty() ? "nothing can move" : "";
}

/// Those by which derivatives are asked for.
std::vector<int> listDirections(const ModelSpec& model) {
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  std::vector<int> directions;
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    if (sampled[i].has_derivatives) {
      directions.push_back(static_cast<int>(i));
    }
  }
  return directions;
}

}  // namespace

LanePrograms::LanePrograms(ModelContext& context, SimbodyModel* simbody)
    : model_(context.model), obstacle_(findObstacle(context)) {
  if (obstacle_.empty()) {
    obstacle_ = compile(context, simbody);
  }
}

const LaneModel& LanePrograms::getDerivatives(const SystemNames& names) {
  const std::lock_guard<std::mutex> guard(compiling_);
  if (!derivatives_) {
    derivatives_ = compileModel(recordModel(model_, names, values_->loops), listDirections(model_));
  }
  return *derivatives_;
}

const StiffPrograms& LanePrograms::getStiff(const SystemNames& names) {
  const std::lock_guard<std::mutex> guard(compiling_);
  if (!stiff_) {
    stiff_ = compileStiff(recordModel(model_, names, values_->loops));
  }
  return *stiff_;
}

/// Returns what prevents it, or "".
std::string LanePrograms::compile(ModelContext& context, SimbodyModel* simbody) {
  requireSteadyMotions(context);
  values_ = compileModel(recordModel(model_, context.names, makeLoopModel(context)));
  if (simbody == nullptr) {
    return "";
  }
  if (findSampledKey(model_).empty()) {
    return compareWithSimbody(context, *simbody, *values_);
  }
  const ModelSpec known = removeSampled(model_);  // what Simbody knows
  return compareWithSimbody(context, *simbody,
                            compileModel(recordModel(known, SystemNames(known.system), values_->loops)));
}

}  // namespace twinmap
