#include "framework/export/c_folder.hpp"

#include <fmt/format.h>

#include <ostream>

#include "framework/export/c_readme.hpp"
#include "framework/export/runtime_sources.hpp"
#include "framework/export/selftest.hpp"
#include "framework/store/atomic_file.hpp"

namespace twinmap {

void writeCFolder(const std::filesystem::path& run, const std::filesystem::path& folder,
                  const COptions& options, std::ostream& log) {
  constexpr int kMeasurements = 50;
  const ExportedModel model = loadExportedModel(run);
  const CSource source = makeCSource(model, options);
  const Inferrer inferrer(run);
  const auto measurements = makeTestedMeasurements(run, inferrer, kMeasurements, options.number);
  std::filesystem::create_directories(folder);
  const std::string stem = options.prefix + "_map";
  writeTextFile(folder / (stem + ".h"), source.header);
  writeTextFile(folder / (stem + ".c"), source.source);
  writeTextFile(folder / "selftest.c", makeSelftest(model, options, measurements));
  writeTextFile(folder / "Makefile", renameC(std::string(getRuntimeSource("Makefile")), options.prefix));
  writeTextFile(folder / "README.md", makeCReadme(model, options, source));
  log << fmt::format("{}: {:.1f} kB of constants for the map, {:.1f} kB for the trust status\n",
                     (folder / (stem + ".c")).string(), static_cast<double>(source.map_bytes) / 1000.0,
                     static_cast<double>(source.trust_bytes) / 1000.0);
}

}  // namespace twinmap
