#include "framework/export/c_code/c_source.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <functional>

#include "framework/base/text/source_location.hpp"
#include "framework/export/c_code/runtime_sources.hpp"

namespace twinmap {
namespace {

void requireIdentifier(const std::string& prefix) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (prefix.empty() || !std::all_of(prefix.begin(), prefix.end(), fits) ||
      std::isdigit(static_cast<unsigned char>(prefix.front())) != 0) {
    throw ExperimentError(fmt::format("--prefix {}: must be a C identifier", prefix));
  }
}

/// The files of kernels/exact/ and runtime/ one after another, each with its tables.
class Composer {
 public:
  Composer(const ExportedModel& model, const COptions& options) : model_(model), options_(options) {
    const GpMap* processes = model.findProcesses();
    addSize("PARAMETERS", model.countParameters(), "that are inferred");
    addSize("KNOWN", model.countKnown(), "inputs of the set-up, known with a measurement");
    addSize("FEATURES", static_cast<Eigen::Index>(model.features.size()), "made of a measurement");
    addSize("SIGNALS", model.takesSignals() ? model.layout.getOutputCount() : 0,
            "measured; 0: only features can be given");
    addSize("ROWS", model.takesSignals() ? model.layout.getRowCount() : 0, "signals times the grid");
    addSize("PROCESSES", processes != nullptr ? 1 : 0, "1: the map is one of Gaussian processes");
    addSize("NETWORK", model.findNetwork() != nullptr ? 1 : 0, "1: the map is a neural network");
    addSize("COMPRESSED", options.compressed ? 1 : 0, "1: the processes are summarised by few inputs");
    addSize("DERIVED", static_cast<Eigen::Index>(model.experiment.derived.size()),
            "quantities that follow from the parameters");
    addSize("TRUST", model.online.trust ? 1 : 0, "1: measurements are judged");
  }

  CSource compose() {
    addPlain("arithmetic.c");
    if (options_.compressed || model_.findForward() != nullptr) {
      addPlain("triangles.c");
    }
    if (model_.takesSignals()) {
      add("resample.c", [&](CTables& tables) { addGrid(model_, tables, source_.sizes); });
      add("features.c", [&](CTables& tables) { addFeatures(model_, tables, source_.sizes); });
    }
    if (const GpMap* map = model_.findProcesses()) {
      add("transform.c",
          [&](CTables& tables) { addTransform(*map, options_.compressed, tables, source_.sizes); });
      if (options_.compressed) {
        add("compressed.c", [&](CTables& tables) { addCompressedProcesses(*map, tables, source_.sizes); });
      } else {
        add("processes.c", [&](CTables& tables) { addProcesses(*map, tables, source_.sizes); });
      }
    }
    if (const NetworkMap* map = model_.findNetwork()) {
      add("network.c", [&](CTables& tables) { addNetwork(*map, tables, source_.sizes); });
    }
    addForward();
    if (model_.online.trust) {
      bytes_ = &source_.trust_bytes;
      add("trust.c", [&](CTables& tables) { addTrust(*model_.online.trust, tables, source_.sizes); });
    }
    bytes_ = &source_.map_bytes;
    add("infer.c", [&](CTables& tables) { addResult(model_, options_.prefix, tables, source_.sizes); });
    addDerivedQuantities();
    finish();
    return std::move(source_);
  }

 private:
  void addSize(const std::string& name, Eigen::Index value, const std::string& meaning) {
    source_.sizes.push_back({name, static_cast<long>(value), meaning});
  }

  /// The processes from parameters to scores, which serve the judgement, and the map where it is a surrogate.
  void addForward() {
    if (model_.findForward() == nullptr) {
      addSize("SCORES", 0, "no surrogate");
      return;
    }
    const Surrogate* surrogate = model_.findSurrogate();
    bytes_ = surrogate != nullptr ? &source_.map_bytes : &source_.trust_bytes;
    add("scores.c", [&](CTables& tables) { addScores(model_, tables, source_.sizes); });
    for (const char* file : {"smooth_process.h", "smooth_process.c", "least_squares.c", "score_search.h",
                             "score_search.c", "score_minima.c"}) {
      addPlain(file);
    }
    add("surrogate.c", [&](CTables& tables) { addWindows(model_, tables, source_.sizes); });
    if (surrogate != nullptr) {
      addPlain("box_moments.c");
      addPlain("score_mixture.c");
      add("surrogate_map.c", [&](CTables& tables) { addSurrogateMap(*surrogate, tables, source_.sizes); });
    }
  }

  void addDerivedQuantities() {
    if (!model_.experiment.derived.empty()) {
      add("derived.c", [&](CTables& tables) { addDerived(model_, options_.prefix, tables); });
      text_ = fillSlot(std::move(text_), "@EXPRESSIONS@", makeDerivedExpressions(model_));
    }
  }

  void addPlain(const char* file) { text_ += "\n" + rename(file); }

  void add(const char* file, const std::function<void(CTables&)>& fill) {
    CTables tables(options_.number);
    fill(tables);
    *bytes_ += tables.getBytes();
    text_ += "\n" + fillSlot(rename(file), "@TABLES@\n", tables.getText());
  }

  std::string rename(const char* file) const {
    return renameC(std::string(getRuntimeSource(file)), options_.prefix);
  }

  const char* getReal() const { return options_.number == CNumber::kSingle ? "float" : "double"; }

  void finish() {
    std::string header =
        fillSlot(rename("twinmap_map.h"), "@SIZES@", writeSizes(source_.sizes, options_.prefix));
    header = fillSlot(std::move(header), "@REAL@", getReal());
    source_.header = fillSlot(std::move(header), "@TITLE@", model_.experiment.name.text);
    source_.source = fmt::format(
        "/* Generated by `twinmap export`: constants, each with its meaning, and what is done with them. */\n"
        "#include \"{}_map.h\"\n\n#include <math.h>\n#include <stdint.h>\n#include <string.h>\n\n"
        "typedef {} real_t;   /* tables that tolerate it */\n"
        "typedef double wide_t;  /* those that would drown in rounding */\n"
        "typedef {} transform_t;\n",
        options_.prefix, getReal(), options_.compressed ? "real_t" : "wide_t");
    source_.source += text_;
  }

  const ExportedModel& model_;
  const COptions& options_;
  CSource source_;
  std::size_t* bytes_ = &source_.map_bytes;
  std::string text_;
};

}  // namespace

std::string writeSizes(const CSizes& sizes, const std::string& prefix) {
  std::string text;
  for (const CSize& size : sizes) {
    text += fmt::format("#define {}_{} {} /* {} */\n", toUpper(prefix), size.name, size.value, size.meaning);
  }
  return text;
}

std::string renameC(std::string text, const std::string& prefix) {
  return fillSlot(fillSlot(std::move(text), "twinmap_", prefix + "_"), "TWINMAP_", toUpper(prefix) + "_");
}

CSource makeCSource(const ExportedModel& model, const COptions& options) {
  requireIdentifier(options.prefix);
  return Composer(model, options).compose();
}

}  // namespace twinmap
