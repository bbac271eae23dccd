#include <fmt/core.h>

#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/export/c_code/c_folder.hpp"
#include "framework/export/fmu_export.hpp"
#include "framework/export/json_export.hpp"
#include "framework/study/pipeline/training/refit_map.hpp"

namespace twinmap::cli {

void exportMap(const ExportArguments& arguments) {
  if (arguments.c_folder.empty() && arguments.fmu.empty() && arguments.json.empty()) {
    throw ExperimentError("export: give --c DIR, --fmu FILE or --json FILE");
  }
  if (!arguments.c_folder.empty()) {
    CFolderOptions options;
    options.c.number = arguments.single ? CNumber::kSingle : CNumber::kDouble;
    options.c.prefix = arguments.prefix;
    options.c.compressed = arguments.compressed;
    options.trust = arguments.trust;
    options.make_exact = [&](const ExperimentSpec& experiment, const GpMap& deployed) {
      return refitExactMap(arguments.run, experiment, deployed);
    };
    writeCFolder(arguments.run, arguments.c_folder, options, std::cout);
  }
  if (!arguments.fmu.empty()) {
    const bool compiled = writeFmu(loadExportedModel(arguments.run), arguments.fmu, arguments.fmi);
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
