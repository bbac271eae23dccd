#include "framework/study/pipeline/trust/power_stencils.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kPoints = 10;              // test samples: power differs over the box
constexpr double kDifferencesShare = 0.2;  // of the run's simulations, where derivatives are differences
constexpr double kConstantSpan = 0.2;      // relative; the interval of a constant that is made a parameter

/// The model in which these constants are unknown parameters, behind all others.
ModelSpec makeConstantsUnknown(ModelSpec model, const std::vector<ParameterSpec>& constants) {
  const auto is_chosen = [&](const ConstantSpec& constant) {
    return std::any_of(constants.begin(), constants.end(),
                       [&](const ParameterSpec& one) { return one.name.text == constant.name.text; });
  };
  model.constants.erase(std::remove_if(model.constants.begin(), model.constants.end(), is_chosen),
                        model.constants.end());
  model.nuisance.insert(model.nuisance.end(), constants.begin(), constants.end());
  for (TrialModel& trial : model.trials) {
    trial.model = makeConstantsUnknown(std::move(trial.model), constants);
  }
  return model;
}

/// kPoints, or as many as their simulations may cost beside the run's own, where a point takes 2 p + 1 of
/// them.
Index countPoints(const Simulator& simulator, std::size_t parameters, const SimulatedSets& sets) {
  if (simulator.hasDerivatives()) {
    return kPoints;
  }
  const auto own = static_cast<double>(sets.train.parameters.cols() + sets.test.parameters.cols());
  const auto affordable =
      static_cast<Index>(kDifferencesShare * own / (2.0 * static_cast<double>(parameters) + 1.0));
  return std::clamp<Index>(affordable, 1, kPoints);
}

/// The first `limit` test samples as points of that model's box.
MatrixXd makePoints(const ExperimentSpec& experiment, const SimulatedSets& sets,
                    const std::vector<ParameterSpec>& constants, Index limit) {
  std::vector<int> samples = findSuccessful(sets.test);
  samples.resize(std::min(samples.size(), static_cast<std::size_t>(limit)));
  const MatrixXd points = sets.test.parameters(Eigen::all, samples);
  const auto unknown = static_cast<Index>(collectUnknown(experiment.model).size());
  const auto count = static_cast<Index>(constants.size());
  MatrixXd extended(points.rows() + count, points.cols());
  extended.topRows(unknown) = points.topRows(unknown);
  extended.middleRows(unknown, count).colwise() = calcBoxCenter(constants);
  extended.bottomRows(points.rows() - unknown) = points.bottomRows(points.rows() - unknown);
  return extended;
}

}  // namespace

std::vector<ParameterSpec> listConstants(const ModelSpec& model) {
  std::vector<ParameterSpec> constants;
  for (const ConstantSpec& constant : model.constants) {
    char* end = nullptr;
    const double value = std::strtod(constant.value.text.c_str(), &end);
    const bool is_used = !model.source || constant.variable;
    if (*end == '\0' && std::abs(value) > 0.0 && is_used) {
      ParameterSpec parameter;
      parameter.name = constant.name;
      parameter.variable = constant.variable;
      parameter.unit = constant.unit;
      const double span = kConstantSpan * std::abs(value);
      parameter.bounds = {value - span, value + span, constant.value.where};
      constants.push_back(parameter);
    }
  }
  return constants;
}

std::vector<Stencil> simulateStencils(const Study& study, const SimulatedSets& sets,
                                      const std::vector<ParameterSpec>& constants) {
  const ModelSpec model = makeConstantsUnknown(study.experiment.model, constants);
  const ResponseLayout& layout = sets.test.layout;
  const std::unique_ptr<Simulator> simulator = makeSimulator(model, layout.times, layout.modes);
  const std::vector<ParameterSpec> unknown_parameters = collectUnknown(model);
  const MatrixXd points =
      makePoints(study.experiment, sets, constants, countPoints(*simulator, unknown_parameters.size(), sets));
  const auto count = static_cast<Index>(constants.size());
  std::vector<Stencil> found;
  Index column = 0;
  for (const LocalModel& local :
       calcLocalModels(*simulator, study.extractor, unknown_parameters, points, study.control.threads)) {
    if (local.status.ok) {
      const Index unknown = local.sensitivities.cols() - count;
      found.push_back({local.features,
                       points.col(column).tail(static_cast<Index>(study.experiment.model.inputs.size())),
                       0.5 * local.sensitivities.leftCols(unknown),
                       local.sensitivities.rightCols(count) / (2.0 * kConstantSpan), local.response});
    }
    ++column;
  }
  return found;
}

}  // namespace twinmap
