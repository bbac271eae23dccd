#include "framework/models/mechanism/simulator/describe_model.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/lanes/instability.hpp"
#include "framework/models/mechanism/lanes/lane_modes.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t kMostShown = 6;  ///< values of a line

std::string describeLine(const char* name, const std::string& value) {
  return fmt::format("{:<20}{}", name, value);
}

/// "a, b, c", or the first ones with "..."
std::string joinFirst(const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += i == 0 ? "" : ", ";
    text += i < kMostShown ? values[i] : "...";
    if (i == kMostShown) {
      break;
    }
  }
  return text;
}

std::string describeEquilibrium(const SystemNames& names, const VectorXd& equilibrium) {
  std::vector<std::string> values;
  const std::vector<std::string>& coordinates = names.getCoordinateNames();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    values.push_back(fmt::format("{} {:.4g} {}", coordinates[i], equilibrium[static_cast<Index>(i)],
                                 getUnit(names.getCoordinates()[i].traits.kind)));
  }
  for (std::size_t i = 0; i < names.getStateNames().size(); ++i) {
    values.push_back(fmt::format("{} {:.4g}", names.getStateNames()[i],
                                 equilibrium[static_cast<Index>(coordinates.size() + i)]));
  }
  return joinFirst(values);
}

std::string describeModes(const std::vector<Mode>& modes) {
  std::vector<std::string> values;
  for (const Mode& mode : modes) {
    values.push_back(fmt::format("{:.4g} Hz (damping ratio {:.2g})", mode.frequency, mode.damping_ratio));
  }
  return values.empty() ? "none oscillates" : joinFirst(values);
}

/// What equilibrium and modes do not see: what switches acts between events alone.
std::string describeLeftOut(const SystemSpec& system) {
  const auto& stops = system.elements.get<Stop>();
  const auto& frictions = system.elements.get<Friction>();
  std::vector<std::string> parts;
  if (std::any_of(stops.begin(), stops.end(), [](const auto& stop) { return stop.isRigid(); })) {
    parts.emplace_back("stops with restitution");
  }
  if (std::any_of(frictions.begin(), frictions.end(), [](const auto& one) { return one.switches(); })) {
    parts.emplace_back("friction with model: coulomb");
  }
  return joinFirst(parts);
}

/// At the centre of the bounds.
void appendRest(ModelContext& context, const LaneModel& lanes, const VectorXd& box_center,
                std::vector<std::string>& lines) {
  const VectorXd center = calcBoxCenter(collectSampled(context.model));
  context.numbers.update(center);
  try {
    const VectorXd no_times;
    const VectorXd equilibrium =
        LaneStart(context.model, lanes, box_center, no_times).solveEquilibrium(center);
    const Eigen::MatrixXd matrix = LaneModes(lanes).calcMatrix(center, equilibrium);
    const bool sampled = !context.model.system.controllers.empty();
    const auto coordinates = static_cast<Index>(context.names.getCoordinateNames().size());
    const bool has_all = matrix.rows() >= 2 * coordinates;  // of loops it has the freedoms that are left
    const std::optional<Instability> instability = findInstability(matrix, has_all ? coordinates : 0);
    lines.push_back(describeLine(
        "equilibrium", describeEquilibrium(context.names, equilibrium) + (instability ? " (unstable)" : "")));
    if (instability && has_all && !sampled) {
      lines.push_back(describeLine(kUnstableLine, describeInstability(*instability, context)));
    }
    lines.push_back(describeLine("modes", describeModes(calcModes(matrix)) +
                                              (sampled ? ", with the outputs of controllers held" : "")));
  } catch (const SimulationFailure& failure) {
    lines.push_back(describeLine("equilibrium", std::string("none near the start: ") + failure.what()));
  }
  if (const std::string left_out = describeLeftOut(context.model.system); !left_out.empty()) {
    lines.push_back(describeLine("without", left_out));
  }
}

}  // namespace

std::vector<std::string> describeModel(ModelContext& context, const LaneModel* lanes,
                                       const VectorXd& box_center) {
  const std::size_t coordinates = context.names.getCoordinateNames().size();
  const std::size_t prescribed = context.model.system.motions.size();
  std::vector<std::string> lines{describeLine("bodies", std::to_string(context.model.system.bodies.size())),
                                 describeLine("coordinates", std::to_string(coordinates))};
  if (lanes != nullptr && lanes->loops) {
    const std::size_t kept = lanes->loops->plan.rows.size(), all = lanes->loops->labels.size();
    lines.push_back(
        describeLine("loops", fmt::format("{} conditions, {} of them redundant", all, all - kept)));
    lines.push_back(describeLine("degrees of freedom", std::to_string(coordinates - prescribed - kept)));
  } else if (context.model.system.constraints.empty()) {
    lines.push_back(describeLine("degrees of freedom", std::to_string(coordinates - prescribed)));
  }
  lines.push_back(describeLine("states", std::to_string(context.names.getStateNames().size())));
  if (lanes != nullptr && lanes->isDifferentiated()) {
    appendRest(context, *lanes, box_center, lines);
  } else if (lanes != nullptr) {
    lines.push_back(
        describeLine("equilibrium", fmt::format("is sought of at most {} coordinates", kMostDifferentiated)));
  }
  return lines;
}

}  // namespace twinmap
