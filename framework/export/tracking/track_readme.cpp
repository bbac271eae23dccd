#include "framework/export/tracking/track_readme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace twinmap {
namespace {

constexpr double kDoubleBytes = 8.0;

double getTrackSize(const CTrackSource& source, const std::string& name) {
  const auto found = std::find_if(source.sizes.begin(), source.sizes.end(),
                                  [&](const CSize& size) { return size.name == "TRACK_" + name; });
  return static_cast<double>(found->value);
}

/// What counts below, in the letters of track.c.
struct Sizes {
  double p, n, conditions, unknown, rates, octaves, window, sweeps;
};

Sizes collectSizes(const ExportedTracking& tracking, const CTrackSource& source) {
  return {static_cast<double>(tracking.space.count()),
          getTrackSize(source, "STATES"),
          getTrackSize(source, "CONDITIONS"),
          getTrackSize(source, "UNKNOWN"),
          getTrackSize(source, "RATES"),
          getTrackSize(source, "OCTAVES"),
          getTrackSize(source, "WINDOW"),
          getTrackSize(source, "SWEEPS")};
}

/// sizeof(PREFIX_track) with 8-byte doubles and 4-byte ints, bytes.
double calcTrackBytes(const Sizes& s) {
  constexpr double kNumbers = 6.0, kInts = 4.0 * 4.0;  // counts, times, surprises, widening; four ints
  const double belief = s.n + s.n * s.n;
  const double filters = s.unknown * s.rates * (belief + 1.0 + s.window);
  const double changes = s.window * s.p * (s.n + 4.0);
  const double rows = s.p * (2.0 * s.n + 4.0);
  return kInts + kDoubleBytes * (kNumbers + s.p + 3.0 * s.conditions + 2.0 * belief + filters + changes +
                                 rows + 2.0 * s.p * s.p + s.octaves);
}

/// An upper bound of the stack that an update takes, bytes: local arrays, and registers of a dozen frames,
/// one in another.
double calcTrackStack(const Sizes& s) {
  constexpr double kRegisters = 5000.0;
  return kRegisters + kDoubleBytes * (12.0 * s.n + 12.0 * s.p + 6.0 * (s.n - s.p + 1.0) + 2.0 * s.rates);
}

/// Of one update at the worst: all parameters seen, a change announced.
struct Operations {
  double multiply_adds = 0.0;
  double functions = 0.0;  ///< exponentials, logarithms, roots
};

Operations countOperations(const Sizes& s) {
  const double p = s.p, n = s.n, beliefs = 1.0 + s.unknown * s.rates;
  const double changes = s.window * p;
  constexpr double kSites = 20.0 * 129.0;  // calcBoxSite()
  const double likelihood = 3.0 * std::pow(p * (p + 1.0) / 2.0, 2) + 12.0 * s.sweeps * p * p * (p - 1.0) +
                            5.0 * p * p * p + 12.0 * kSites * p;
  const double filters = beliefs * (p * (2.0 * n * n + 4.0 * n) + 2.0 * p * n);
  const double changed = (changes + p) * p * (2.0 * n + 8.0) + changes * (4.0 * n * n + 2.0 * n);
  const double rates = 5.0 * s.unknown * s.octaves * 10.0;
  Operations operations;
  operations.multiply_adds = likelihood + filters + changed + rates;
  operations.functions = s.sweeps * p * (p - 1.0) * 4.0 + kSites * p + beliefs * p + changes * (p + 4.0) +
                         5.0 * changes + 5.0 * s.unknown * (s.octaves + 1.0) + 3.0 * s.unknown * s.rates +
                         14.0 * p;
  return operations;
}

std::string describeDrifts(const ExportedModel& model, const ExportedTracking& tracking) {
  std::string text = "| parameter | moves |\n|---|---|\n";
  for (std::size_t j = 0; j < tracking.model.drifts.size(); ++j) {
    const tracking::Drift& drift = tracking.model.drifts[j];
    const std::string walk = std::isnan(drift.rate) ? "walks at a rate that is learnt"
                             : drift.rate > 0.0     ? "walks at a known rate"
                                                    : "is constant";
    text += fmt::format("| {} | {}{} |\n", model.experiment.model.parameters[j].name.text, walk,
                        drift.has_slope ? ", and has a slope" : "");
  }
  if (!tracking.conditions.empty()) {
    text += fmt::format("\nConditions, in this order: {}. Each is the mean of its column over the window.\n",
                        fmt::join(tracking.conditions, ", "));
  }
  return text;
}

constexpr const char* kCall = R"(
## Track

`{0}_track.c` and `{0}_track.h` follow the parameters from one measurement to the next, as `twinmap track --no-refine`
does. `make test` runs `track_selftest.c` as well.

```c
#include "{0}_track.h"

static {0}_track track; /* one a machine */
{0}_track_answer answer;
{0}_track_begin(&track);
/* after each {0}_infer(): */
if ({0}_track_update(&track, &result, time, conditions, &answer) == {1}_TRACK_OK) {{
  /* answer.mean[i] +- answer.sd[i]; answer.alarm: a change of answer.parameter */
}}
```

)";

constexpr const char* kDiffers = R"(
What it does not do, and `twinmap track` does:

- Late measurements: one whose time is before the last one's is refused ({1}_TRACK_ERROR_TIME).
- The same measurement again: it is counted again.
- Rivals of a change, forecasts of limits, history.
- Statuses other than model_mismatch that keep a measurement from updating: they need the simulator.
- Where points that lie apart explain a measurement alike, their common mean and covariance are taken; `twinmap track`
  weighs each by the belief.
)";

}  // namespace

std::string makeTrackReadme(const ExportedModel& model, const ExportedTracking& tracking,
                            const std::string& prefix, const CTrackSource& source) {
  const Sizes sizes = collectSizes(tracking, source);
  const Operations operations = countOperations(sizes);
  const std::string upper = toUpper(prefix);
  return fmt::format(kCall, prefix, upper) + describeDrifts(model, tracking) +
         fmt::format(
             "\n| what | bytes |\n|---|---|\n| constants of the tracker (flash) | {} |\n| `{}_track` (RAM) "
             "| {:.0f} |\n| stack of an update, at most | {:.0f} |\n\nAn update takes at most {:.1f} "
             "thousand multiply-adds and {:.1f} thousand exponentials, logarithms and roots, all in "
             "double.\n",
             source.bytes, prefix, calcTrackBytes(sizes), calcTrackStack(sizes),
             operations.multiply_adds / 1000.0, operations.functions / 1000.0) +
         fmt::format(kDiffers, prefix, upper);
}

}  // namespace twinmap
