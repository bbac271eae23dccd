#include "framework/export/c_folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <ostream>
#include <string>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/export/c_code/runtime_sources.hpp"
#include "framework/export/c_code/selftest.hpp"
#include "framework/export/model/compress_map.hpp"
#include "framework/export/tracking/track_readme.hpp"
#include "framework/export/tracking/track_selftest.hpp"
#include "framework/inference/inferrer.hpp"
#include "kernels/gp/online/process_view.hpp"

namespace twinmap {

namespace {

constexpr std::size_t kDouble = 8;

std::size_t getSize(const CSource& source, const std::string& name) {
  const auto found = std::find_if(source.sizes.begin(), source.sizes.end(),
                                  [&](const CSize& size) { return size.name == name; });
  return found == source.sizes.end() ? 0 : static_cast<std::size_t>(found->value);
}

/// Doubles of the state that belong to the search for the point that explains the scores.
std::size_t countSearch(const CSource& source) {
  const auto size = [&](const char* name) { return getSize(source, name); };
  const std::size_t r = size("SCORES"), w = size("WINDOWS"), n = size("POINTS"), m = size("VARIABLES"),
                    terms = size("TERMS");
  if (r == 0) {
    return 0;
  }
  const std::size_t processes =
      w * n * (m + 4) + size("SLOPE_POINTS") + 1 + w * terms + terms * m + size("PADDED_POINTS");
  return processes + size("SEARCH") + r + 1;
}

std::string makeParameterTable(const std::vector<ParameterSpec>& parameters) {
  std::string table = "| name | unit | trained within |\n|---|---|---|\n";
  for (const ParameterSpec& parameter : parameters) {
    table += fmt::format("| {} | {} | {} to {} |\n", parameter.name.text, parameter.unit,
                         toText(parameter.bounds.lower), toText(parameter.bounds.upper));
  }
  return table;
}

std::string describeSignals(const ExportedModel& model, const std::string& prefix) {
  if (!model.takesSignals()) {
    return fmt::format("The features are modes, which no signal gives: call `{}_infer_features`.\n", prefix);
  }
  const Eigen::VectorXd& times = model.layout.times;
  std::string text = "| signal | unit |\n|---|---|\n";
  for (std::size_t i = 0; i < model.layout.output_names.size(); ++i) {
    text += fmt::format("| {} | {} |\n", model.layout.output_names[i], model.layout.output_units[i]);
  }
  return text +
         fmt::format(
             "\nThey are resampled at {} times from {} s to {} s (`grid_times`), 0 being the model's: the "
             "measured value where a time agrees within 1e-6 of the median step, else the cubic through the "
             "four nearest samples. A median step of at most {} s is needed for that. The signals must be "
             "responses to the excitation that the map was trained on; this is not checked here.\n",
             times.size(), toText(times[0]), toText(times[times.size() - 1]),
             toText(1.01 * model.sample_interval.value_or(0.0)));
}

std::string describeFeatures(const ExportedModel& model) {
  std::string text;
  for (const FeatureInfo& info : model.features) {
    text += (text.empty() ? "" : ", ") + info.name + (info.unit.empty() ? "" : " [" + info.unit + "]");
  }
  return text;
}

/// Multiply-adds of one evaluation of the processes from parameters to scores, with derivatives; in
/// thousands.
double countEvaluation(const ExportedModel& model) {
  double sum = 0.0;
  for (const gp::SharedProcess& process : model.findForward()->windows) {
    const gp::SharedProcessParts parts = process.getParts();
    sum += static_cast<double>(parts.scaled_points.size() + parts.weights.size());
  }
  return 2.0 * sum / 1000.0;
}

std::string describeOperations(const NetworkMap& map) {
  const network::Network& network = map.members.front().network;
  Eigen::Index sum = map.inputs.projection.size() + network.skip.size(), units = 0;
  for (const network::Layer& layer : network.layers) {
    sum += layer.weights.size();
    units += layer.weights.cols();
  }
  return fmt::format("The map takes {:.1f} thousand multiply-adds and {} exponentials.",
                     static_cast<double>(sum) / 1000.0,
                     units - network.countInputs() + network.countTargets());
}

std::string describeOperations(const ExportedModel& model) {
  std::string text;
  if (const NetworkMap* map = model.findNetwork()) {
    text = describeOperations(*map);
  }
  if (const GpMap* map = model.findProcesses()) {
    double sum = 0.0;
    for (const gp::Process& process : map->processes) {
      const gp::ProcessView view = gp::viewProcess(process);
      const auto n = static_cast<double>(view.inputs.cols()), d = static_cast<double>(view.inputs.rows());
      sum += n * (3.0 * d + (view.correction != nullptr ? n : 0.5 * n));
    }
    text += fmt::format("The map takes {:.0f} thousand multiply-adds.", sum / 1000.0);
  }
  if (const ForwardSurrogate* forward = model.findForward()) {
    const auto r = static_cast<double>(forward->getScoreCount());
    text += fmt::format(
        " {} evaluates the processes from parameters to scores and their derivatives some {} times, {:.0f} "
        "thousand multiply-adds each, and factorises up to twice a matrix of {} rows ({:.0f} thousand); more "
        "where several points explain a measurement alike.",
        model.findSurrogate() != nullptr ? "An inference" : "The judgement",
        model.findSurrogate() != nullptr ? 15 : 8, countEvaluation(model), r, r * r * r / 6000.0);
  }
  return text;
}

constexpr const char* kStatuses =
    "| status | bit | meaning |\n|---|---|---|\n"
    "| ok | 0 | no test found a fault |\n"
    "| model_mismatch | 1 | no parameter values within the bounds fit the measurement within its noise |\n"
    "| outside_training | 2 | the features are far from all the map was trained on |\n"
    "| at_bounds | 4 | a parameter lies beyond its bounds |\n"
    "| uninformative | 8 | a parameter's sd is close to that of its bounds |\n"
    "| estimator_limited | 16 | the errors are mostly the map's own, or not known to it |\n"
    "| not_judged | 32 | the run has no trust model |\n";

/// What it is, how it is compiled and called. upper: the prefix as macros have it.
std::string describeUse(const ExportedModel& model, const std::string& prefix, const std::string& upper) {
  std::string text = fmt::format(
      "# {0}: measured signals to parameters, in C99\n\nWritten by `twinmap export`. `{1}_map.c` and "
      "`{1}_map.h` need libm alone: no heap, no recursion, no variables of their own. `make test` runs "
      "`selftest.c`: {2} measurements with twinmap's estimates (`CC`, `CFLAGS`, `LDFLAGS` and `RUN` as for "
      "other compilers and emulators). Compile with `-std=c99`, or `-ffp-contract=off`: which products are "
      "fused with sums is chosen in the source. With fused multiply-adds (`-march=native`, AArch64) it is "
      "fastest.\n\n"
      "## Call\n\n```c\n#include \"{1}_map.h\"\n\nstatic {1}_state state; /* one a thread; needs no "
      "initialisation */\n{1}_result result;\n",
      model.experiment.name.text, prefix, 50);
  text += model.takesSignals()
              ? fmt::format(
                    "const {0}_real *signals[{1}_SIGNALS] = {{...}};\nif ({0}_infer(&state, count, times, "
                    "signals, start, known, &result) == {1}_OK) {{\n",
                    prefix, upper)
              : fmt::format("if ({0}_infer_features(&state, features, known, &result) == {1}_OK) {{\n",
                            prefix, upper);
  text += fmt::format(
      "  /* result.mean[i] +- result.sd[i]; result.status, {0}_status_text(result.status) */\n}}\n```\n\n"
      "`known`: NULL where the set-up has no known inputs. `{0}_infer_features` takes the features "
      "themselves. The estimates are those of `twinmap infer --no-refine`, bit for bit on processors that "
      "multiply and add at once: for x86-64 the file asks GCC and clang for AVX2 and FMA itself. For those "
      "before 2013 compile with `-D{1}_ANY_PROCESSOR`.\n",
      prefix, upper);
  return text;
}

/// sizeof(PREFIX_state) with 8-byte doubles and 4-byte ints, bytes.
std::size_t calcStateBytes(const CSource& source) {
  const auto size = [&](const char* name) { return getSize(source, name); };
  const std::size_t inputs = size("INPUTS") + size("KNOWN");
  std::size_t doubles = size("ROWS") + 1 + size("FEATURES") + inputs + countSearch(source);
  if (size("PROCESSES") > 0) {
    doubles += 2 * inputs + size("DIRECTIONS") + 1 + 6 * size("LARGEST") + size("COEFFICIENTS") + 1;
  }
  if (size("COMPRESSED") > 0) {
    doubles += size("LARGEST") * (size("LARGEST") + 1) / 2;
  }
  if (size("NETWORK") > 0) {
    doubles += size("FEATURES") + size("PRODUCTS") + 1 + 2 * size("WIDEST") +
               size("PARAMETERS") * size("PARAMETERS");
  }
  if (size("TRUST") > 0) {
    doubles += size("FEATURES") + size("RESIDUALS") + inputs;
  }
  return doubles * kDouble;
}

/// An upper bound of the stack that an inference takes, bytes: the local arrays and a reserve for registers.
std::size_t calcStackBytes(const CSource& source) {
  constexpr std::size_t kRegisters = 6000;  // forty small frames, one in another
  constexpr std::size_t kKernels = 800;     // doubles of the widest loops
  constexpr std::size_t kSearches = 250;    // doubles of two searches' addresses
  const auto size = [&](const char* name) { return getSize(source, name); };
  return kDouble * (kKernels + kSearches + 5 * size("UNKNOWN") + size("UNMODELLED") + size("TERMS") +
                    size("SIGNALS")) +
         kRegisters;
}

std::string describeMemory(const ExportedModel& model, const COptions& options, const CSource& source) {
  const bool single = options.number == CNumber::kSingle;
  return fmt::format(
      "## Memory and time\n\n| what | bytes |\n|---|---|\n| constants of the map (flash) | {} |\n| constants "
      "of the trust status (flash) | {} |\n| `{}_state` (RAM) | {} |\n| stack, at most | {} |\n\n{}\n\n{}\n",
      source.map_bytes, source.trust_bytes, options.prefix, calcStateBytes(source), calcStackBytes(source),
      describeOperations(model),
      single ? "Signals, features and the tables that tolerate it are float. The weights of smooth processes "
               "cancel to a millionth of their size, and variances are small differences: what enters these, "
               "and the estimates themselves, whose sd may be below what a float of the mean resolves, are "
               "double."
             : "All numbers are double.");
}

/// README.md of exported C: how to call it, what it needs, what its answers mean.
std::string makeCReadme(const ExportedModel& model, const COptions& options, const CSource& source) {
  std::string upper = options.prefix;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string text = describeUse(model, options.prefix, upper);
  text += "\n## Parameters\n\n" + makeParameterTable(model.experiment.model.parameters);
  if (!model.experiment.model.inputs.empty()) {
    text += "\nKnown inputs, in this order:\n\n" + makeParameterTable(model.experiment.model.inputs);
  }
  text += "\n## Signals\n\n" + describeSignals(model, options.prefix);
  text += "\nFeatures, in this order: " + describeFeatures(model) + ".\n";
  text += fmt::format(
      "\n## Status\n\n{}\n`result.statuses` has the bits of all that apply, `result.status` the most severe "
      "(the least bit).\n\n",
      kStatuses);
  return text + describeMemory(model, options, source);
}

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
      "deviations by {:.2g} %, at most over the parameters.\n",
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

/// What of it README.md says.
std::string writeTracker(const std::filesystem::path& folder, const CFolderOptions& options,
                         const ExportedModel& model, const std::vector<TestedMeasurement>& measurements) {
  const std::string& prefix = options.c.prefix;
  const ExportedTracking tracking = makeExportedTracking(options.tracking, model);
  const CTrackSource source = makeTrackSource(model, tracking, prefix);
  writeTextFile(folder / (prefix + "_track.h"), source.header);
  writeTextFile(folder / (prefix + "_track.c"), source.source);
  writeTextFile(folder / "track_selftest.c", makeTrackSelftest(model, tracking, prefix, measurements));
  return makeTrackReadme(model, tracking, prefix, source);
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
  const std::string tracker = options.track ? writeTracker(folder, options, model, measurements) : "";
  writeTextFile(folder / "README.md",
                makeCReadme(model, options.c, source) + (loss.empty() ? "" : "\n" + loss) + tracker);
  log << fmt::format(
      "{}: {:.1f} kB of C: {:.1f} kB of constants for the map, {:.1f} kB for the trust status\n{}{}",
      (folder / (stem + ".c")).string(), kilo(source.source.size()), kilo(source.map_bytes),
      kilo(source.trust_bytes), adviseOnSize(source, options), loss);
}

}  // namespace twinmap
