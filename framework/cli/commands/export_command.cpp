#include <fmt/core.h>

#include <iostream>
#include <optional>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/export/c_folder.hpp"
#include "framework/export/fmu_export.hpp"
#include "framework/export/json_export.hpp"
#include "framework/study/pipeline/training/refit_map.hpp"
#include "framework/tracking/track_session.hpp"

namespace twinmap::cli {

void exportMap(const ExportArguments& arguments) {
  if (arguments.c_folder.empty() && arguments.fmu.empty() && arguments.json.empty()) {
    throw ExperimentError("export: give --c DIR, --fmu FILE or --json FILE");
  }
  if (arguments.track && arguments.c_folder.empty() && arguments.fmu.empty()) {
    throw ExperimentError("export --track: trackers are C: give --c DIR or --fmu FILE");
  }
  const std::optional<TrackingSpec> tracking = findTracking("", arguments.tracking);
  if (!arguments.c_folder.empty()) {
    CFolderOptions options;
    options.c.number = arguments.single ? CNumber::kSingle : CNumber::kDouble;
    options.c.prefix = arguments.prefix;
    options.c.compressed = arguments.compressed;
    options.trust = arguments.trust;
    options.track = arguments.track;
    options.tracking = tracking;
    options.make_exact = [&](const ExperimentSpec& experiment, const GpMap& deployed) {
      return refitExactMap(arguments.run, experiment, deployed);
    };
    writeCFolder(arguments.run, arguments.c_folder, options, std::cout);
  }
  if (!arguments.fmu.empty()) {
    const ExportedModel model = loadExportedModel(arguments.run);
    std::optional<ExportedTracking> tracker;
    if (arguments.track) {
      tracker = makeExportedTracking(tracking, model);
    }
    const bool compiled = writeFmu(model, arguments.fmu, arguments.fmi, tracker ? &*tracker : nullptr);
    std::cout << fmt::format(
        "{}: FMI {}.0, Co-Simulation{}\n", arguments.fmu, arguments.fmi,
        compiled ? ""
                 : ", in sources alone: there is no C compiler here (cc, or CC) to make a library of them");
  }
  if (!arguments.json.empty()) {
    writeTextFile(arguments.json, makeMapJson(loadExportedModel(arguments.run)));
    std::cout << fmt::format("{}: all numbers of the estimator\n", arguments.json);
  }
}

}  // namespace twinmap::cli
