#include "framework/export/c_code/c_folder.hpp"

#include <fmt/core.h>

#include <ostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/export/c_code/c_readme.hpp"
#include "framework/export/c_code/runtime_sources.hpp"
#include "framework/export/c_code/selftest.hpp"
#include "framework/export/model/compress_map.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

namespace {

/// Replaces the map by one that is smaller; tells what that costs.
std::string compressModel(const std::filesystem::path& run, const CFolderOptions& options,
                          ExportedModel& model) {
  constexpr int kMeasurements = 500;
  constexpr double kMaxLoss = 0.02;  // of a standard deviation
  if (model.findProcesses() == nullptr) {
    throw ExperimentError(fmt::format("export --compress: the map is a {}, which has no inducing inputs",
                                      model.online.map->getKind()));
  }
  const auto measurements = makeTestedMeasurements(run, model, {kMeasurements, CNumber::kDouble, false});
  CompressionTest test{Eigen::MatrixXd(model.features.size(), measurements.size()),
                       Eigen::MatrixXd(model.countKnown(), measurements.size())};
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    test.features.col(static_cast<Eigen::Index>(i)) = measurements[i].features;
    test.known.col(static_cast<Eigen::Index>(i)) = measurements[i].known;
  }
  CompressedMap compressed =
      compressMap(options.make_exact(model.experiment, *model.findProcesses()), test, kMaxLoss);
  model.online.map = std::make_shared<const OnlineProcesses>(std::move(compressed.map));
  return fmt::format(
      "Compressed: on {} simulated measurements means move by {:.2g} sd (root mean square) and standard "
      "deviations "
      "by {:.2g} %, at most over the parameters.\n",
      measurements.size(), compressed.mean_loss, 100.0 * compressed.stddev_loss);
}

template <class Bytes>
double kilo(Bytes bytes) {
  return static_cast<double>(bytes) / 1000.0;
}

/// "" where a controller has room for it.
std::string adviseOnSize(const CSource& source, const CFolderOptions& options) {
  constexpr double kRoom = 2000.0;  // kB of flash: the largest of usual microcontrollers
  return kilo(source.map_bytes + source.trust_bytes) < kRoom ? ""
         : options.c.compressed
             ? "  More than a controller holds; a network is smaller: inverse_map=network\n"
             : "  More than a controller holds: --compress, --no-trust, or a network (inverse_map=network)\n";
}

}  // namespace

void writeCFolder(const std::filesystem::path& run, const std::filesystem::path& folder,
                  const CFolderOptions& options, std::ostream& log) {
  ExportedModel model = loadExportedModel(run);
  if (!options.trust) {
    model.online.trust.reset();
  }
  const std::string loss = options.c.compressed ? compressModel(run, options, model) : "";
  const CSource source = makeCSource(model, options.c);
  const auto measurements = makeTestedMeasurements(run, model, {50, options.c.number, true});
  std::filesystem::create_directories(folder);
  const std::string stem = options.c.prefix + "_map";
  writeTextFile(folder / (stem + ".h"), source.header);
  writeTextFile(folder / (stem + ".c"), source.source);
  writeTextFile(folder / "selftest.c", makeSelftest(model, options.c, measurements));
  writeTextFile(folder / "Makefile", renameC(std::string(getRuntimeSource("Makefile")), options.c.prefix));
  writeTextFile(folder / "README.md",
                makeCReadme(model, options.c, source) + (loss.empty() ? "" : "\n" + loss));
  log << fmt::format(
      "{}: {:.1f} kB of C: {:.1f} kB of constants for the map, {:.1f} kB for the trust status\n{}{}",
      (folder / (stem + ".c")).string(), kilo(source.source.size()), kilo(source.map_bytes),
      kilo(source.trust_bytes), adviseOnSize(source, options), loss);
}

}  // namespace twinmap
