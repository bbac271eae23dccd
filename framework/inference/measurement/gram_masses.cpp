#include "framework/inference/measurement/gram_masses.hpp"

#include "framework/base/log/search_stage.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {

std::string explainByGrams(const MeasurementReader& reader, const SimulatorRefiner& simulator,
                           const AvailableFeatures& found, const Eigen::VectorXd& known,
                           const SimulatorFit& fit) {
  const ExperimentSpec& experiment = reader.getExperiment();
  const std::vector<BodySpec>& bodies = experiment.model.system.bodies;
  if (experiment.model.source || !simulator.samplesFast() || !fit.isGross()) {
    return "";
  }
  std::vector<std::vector<std::size_t>> tried;  // bodies whose masses may be in g
  std::vector<std::size_t> all;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    double mass = 0.0;
    if (parseLiteral(bodies[body].mass.text, mass)) {
      tried.push_back({body});
      all.push_back(body);
    }
  }
  if (all.size() > 1) {
    tried.push_back(all);
  }
  const SearchStage stage = SearchStage::supposing("are masses in g");
  for (const std::vector<std::size_t>& heavy : tried) {
    ExperimentSpec light = experiment;
    std::string names;
    for (const std::size_t body : heavy) {
      light.model.system.bodies[body].mass.text = "0.001 * " + bodies[body].mass.text;
      names += (names.empty() ? "" : ", ") + bodies[body].name.text;
    }
    const SimulatorRefiner refiner(light, reader.getLayout());
    if (refiner.findLeastChiSquare(found.features, known, static_cast<Eigen::Index>(found.available.size())) <
        kRestOfGross * fit.chi_square) {
      return "the mass of " + names +
             " is 1000 times too large, as g in the place of kg (that explains 99 % of the misfit)";
    }
  }
  return "";
}

}  // namespace twinmap
