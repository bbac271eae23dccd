#include "framework/inference/measurement/required_modes.hpp"

#include <fmt/core.h>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

void requireModes(const AvailableFeatures& found, const MeasurementReader& reader,
                  const std::string& source) {
  const ResponseLayout& layout = reader.getLayout();
  const auto is_missing = [&](Eigen::Index first) {
    return found.response.segment(first, layout.modes).array().isNaN().all();
  };
  if (layout.modes == 0 || found.response.size() != layout.getRowCount()) {
    return;
  }
  const bool no_frequencies = is_missing(layout.getFrequencyRow(0)),
             no_ratios = is_missing(layout.getDampingRow(0));
  for (const FeatureSpec& feature : reader.getExperiment().features) {
    const auto* modes = std::get_if<ModesFeatureSpec>(&feature);
    const bool lacks_all = modes != nullptr && no_frequencies != no_ratios &&
                           ((modes->frequencies && no_frequencies) || (modes->damping_ratios && no_ratios));
    if (lacks_all) {
      const char* column = no_frequencies ? "frequency" : "damping_ratio";
      const char* key = no_frequencies ? "frequencies" : "damping_ratios";
      throw MeasurementError(
          fmt::format("{}: its table of modes has no numbers in a column '{}', which features ask for; name "
                      "the column so, "
                      "or write modes: {{..., {}: false}}",
                      source, column, key));
    }
  }
}

}  // namespace twinmap
