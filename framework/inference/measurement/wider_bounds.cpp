#include "framework/inference/measurement/wider_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "framework/base/log/search_stage.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

Bounds widen(const Bounds& bounds) {
  constexpr double kFurther = 4.0;  // a part taken for another one, not another unit
  const auto move = [](double bound, bool outwards) {
    return outwards ? kFurther * bound : bound / kFurther;
  };
  Bounds wide = bounds;
  wide.lower = move(bounds.lower, bounds.lower < 0.0);
  wide.upper = move(bounds.upper, bounds.upper > 0.0);
  return wide;
}

bool isNamed(const std::vector<std::string>& names, const ParameterSpec& parameter) {
  return std::find(names.begin(), names.end(), parameter.name.text) != names.end();
}

/// The experiment with wider bounds of those named that have no prior.
ExperimentSpec widenBounds(ExperimentSpec experiment, const std::vector<std::string>& names) {
  for (std::vector<ParameterSpec>* all : {&experiment.model.parameters, &experiment.model.nuisance}) {
    for (ParameterSpec& parameter : *all) {
      if (isNamed(names, parameter) && !parameter.prior) {
        parameter.bounds = widen(parameter.bounds);
      }
    }
  }
  return experiment;
}

std::string describe(const ParameterSpec& parameter, double value) {
  return fmt::format("{} fits at {}{}{} (bounds {} .. {})", parameter.name.text,
                     toShortText(value, kStddevDigits), parameter.unit.empty() ? "" : " ", parameter.unit,
                     toShortText(parameter.bounds.lower, kEstimateDigits),
                     toShortText(parameter.bounds.upper, kEstimateDigits));
}

}  // namespace

std::string explainByBounds(const MeasurementReader& reader, const SimulatorRefiner& simulator,
                            const AvailableFeatures& found, const Eigen::VectorXd& known,
                            const SimulatorFit& fit) {
  if (fit.beyond.empty() || !fit.isGross() || !simulator.samplesFast()) {
    return "";
  }
  const SearchStage stage = SearchStage::supposing("do values beyond the bounds explain it");
  const ExperimentSpec wide = widenBounds(reader.getExperiment(), fit.beyond);
  const SimulatorRefiner refiner(wide, reader.getLayout(), simulator.getSimulator().clone(), found.stated);
  const LeastMisfit best = refiner.findLeastMisfit(found.features, known, fit.best);
  if (!(best.chi_square < kRestOfGross * fit.chi_square)) {
    return "";
  }
  const std::vector<ParameterSpec> unknown = collectUnknown(reader.getExperiment().model);
  std::vector<std::string> outside;
  for (std::size_t j = 0; j < unknown.size(); ++j) {
    const double value = best.best[static_cast<Eigen::Index>(j)];
    if (value < unknown[j].bounds.lower || value > unknown[j].bounds.upper) {
      outside.push_back(describe(unknown[j], value));
    }
  }
  return fmt::format("{}: widen these bounds, if that may be", fmt::join(outside, ", "));
}

}  // namespace twinmap
