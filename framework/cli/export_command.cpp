#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/export/c_folder.hpp"
#include "framework/spec/yaml/source_location.hpp"

namespace twinmap::cli {

void exportMap(const ExportArguments& arguments) {
  if (arguments.c_folder.empty()) {
    throw ExperimentError("export: give --c DIR, --fmu FILE or --json FILE");
  }
  COptions options;
  options.number = arguments.single ? CNumber::kSingle : CNumber::kDouble;
  options.prefix = arguments.prefix;
  writeCFolder(arguments.run, arguments.c_folder, options, std::cout);
}

}  // namespace twinmap::cli
