#include "framework/inference/measurement/unstated_noise.hpp"

#include <fmt/core.h>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/recording/recorded_times.hpp"
#include "framework/inference/measurement/excitation_noise.hpp"
#include "framework/inference/measurement/unknown_excitation.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<std::string> describeUnstatedNoise(const MeasurementReader& reader,
                                               const SimulatorRefiner& simulator,
                                               const AvailableFeatures& found, const VectorXd& known,
                                               const PosteriorEstimate& posterior) {
  constexpr double kShare = 0.01;  // of the signal's root mean square; the effect of less is linear
  constexpr Index kMost = 3000;    // features: its cost is their cube
  const ModelSpec& model = reader.getExperiment().model;
  std::vector<std::string> described;
  if (!posterior.fit || !posterior.fit->isSimulated() || !simulator.samplesFast() ||
      !areSamples(reader.getExperiment().features) || static_cast<Index>(found.available.size()) > kMost) {
    return described;
  }
  std::optional<LinearizedMeasurement> local;
  for (std::size_t s = 0; s < model.excitation.size(); ++s) {
    double size = 0.0;
    const std::optional<ModelSpec> supposed = supposeNoise(model, s, kShare, size);
    if (!supposed) {
      continue;
    }
    local = local ? local : simulator.linearize(found.features, known, posterior.fit->best);
    if (!local || !local->whitener) {
      return described;
    }
    VectorXd point(posterior.fit->best.size() + known.size());
    point << posterior.fit->best, known;
    const MatrixXd responses = calcUnknownResponses(*supposed, reader.getLayout(), point);
    const double found_size = findNoiseSize(*local, simulator.getExtractor(), responses, *posterior.fit);
    if (found_size > 0.0) {
      described.push_back(
          fmt::format("noise of {} of about {} {} ({} % of it) may be what is left, and moves the parameters "
                      "by more than "
                      "their standard deviations say: if its sensor has so much, state it as measured.noise",
                      model.excitation[s].name.text, toShortText(found_size * size, 2),
                      model.excitation[s].unit, toShortText(100.0 * kShare * found_size, 2)));
    }
  }
  return described;
}

}  // namespace twinmap
