#include <fmt/core.h>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/features/layout_rows.hpp"
#include "framework/export/c_code/c_model_tables.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

/// The same features with complex numbers left as real and imaginary part, which are linear in the response.
std::vector<FeatureSpec> splitComplex(std::vector<FeatureSpec> features) {
  for (FeatureSpec& feature : features) {
    if (auto* spectrum = std::get_if<SpectrumFeatureSpec>(&feature)) {
      spectrum->parts = ComplexParts::kRealImaginary;
    }
    if (auto* response = std::get_if<FrequencyResponseFeatureSpec>(&feature)) {
      response->parts = ComplexParts::kRealImaginary;
    }
  }
  return features;
}

bool isMagnitudePhase(const FeatureSpec& feature) {
  const auto* spectrum = std::get_if<SpectrumFeatureSpec>(&feature);
  const auto* response = std::get_if<FrequencyResponseFeatureSpec>(&feature);
  return (spectrum != nullptr && spectrum->parts == ComplexParts::kMagnitudePhase) ||
         (response != nullptr && response->parts == ComplexParts::kMagnitudePhase);
}

/// The C blocks and the tables that they refer to.
class Blocks {
 public:
  explicit Blocks(const ResponseLayout& layout) : layout_(layout) { starts_.push_back(0); }

  void add(const FeatureSpec& feature, const FeatureExtractor& extractor) {
    if (const auto* statistics = std::get_if<StatisticsFeatureSpec>(&feature)) {
      addLinear(extractor, false);
      addStatistics(*statistics);
    } else if (const auto* extrema = std::get_if<ExtremaFeatureSpec>(&feature)) {
      addExtrema(*extrema);
    } else {
      addLinear(extractor, isMagnitudePhase(feature));
    }
  }

  void write(CTables& tables, CSizes& sizes) const {
    const bool selected = (Eigen::Map<const Eigen::ArrayXd>(weights_.data(), size(weights_)) == 1.0).all();
    tables.addInts("feature_starts", starts_,
                   "Where the entries of each row of the features' matrices begin.");
    if (!rows_.empty()) {
      tables.addInts("feature_rows", rows_, "Rows of the response that the matrices' entries stand for.");
    }
    if (!window_rows_.empty()) {
      tables.addInts("window_rows", window_rows_, "Rows of the response: samples of windows.");
    }
    if (!selected) {
      tables.addWide("feature_weights", Eigen::Map<const Eigen::VectorXd>(weights_.data(), size(weights_)),
                     "Entries of the features' matrices, in units of features per unit of the signal.");
    }
    tables.addStructs("feature_block", "feature_blocks", entries_, "Features, block after block.");
    sizes.push_back({"BLOCKS", static_cast<long>(entries_.size()), "groups of features"});
    sizes.push_back({"MATRICES", rows_.empty() ? 0 : 1, "1: some features are linear in the response"});
    sizes.push_back({"SELECTED", selected ? 1 : 0, "1: features are samples of the response"});
    sizes.push_back({"STATISTICS", statistics_ ? 1 : 0, "1: some features are statistics"});
    sizes.push_back({"EXTREMA", extrema_ ? 1 : 0, "1: some features are extrema"});
  }

 private:
  static Index size(const std::vector<double>& values) { return static_cast<Index>(values.size()); }

  void addLinear(const FeatureExtractor& extractor, bool magnitude_phase) {
    for (const auto& block : extractor.getBlocks()) {
      if (const FeatureMatrix* matrix = block->findMatrix()) {
        addMatrix(*matrix, magnitude_phase);
      }
    }
  }

  void addMatrix(const FeatureMatrix& matrix, bool magnitude_phase) {
    const std::size_t first = starts_.size() - 1;
    for (Index row = 0; row < matrix.rows(); ++row) {
      for (FeatureMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
        rows_.push_back(static_cast<int>(entry.col()));
        weights_.push_back(entry.value());
      }
      starts_.push_back(static_cast<int>(rows_.size()));
    }
    entries_.push_back(fmt::format("{}, {}, {}, 0, 0, 0, 0, 0.0, 0.0, 0.0",
                                   magnitude_phase ? "BLOCK_MAGNITUDE_PHASE" : "BLOCK_LINEAR", matrix.rows(),
                                   first));
  }

  int addWindow(const std::string& output, const WindowSpec& window) {
    const auto first = static_cast<int>(window_rows_.size());
    for (const Index row : findRows(layout_, findOutput(layout_, output), window)) {
      window_rows_.push_back(static_cast<int>(row));
    }
    return first;
  }

  void addStatistics(const StatisticsFeatureSpec& spec) {
    for (const Name& output : spec.outputs) {
      for (const Statistic statistic : spec.quantities) {
        if (statistic != Statistic::kMean) {
          statistics_ = true;
          entries_.push_back(fmt::format("BLOCK_STATISTIC, STATISTIC_{}, {}, {}, 0, 0, 0, 0.0, 0.0, 0.0",
                                         toUpper(getEnumText(statistic)), addWindow(output.text, spec.window),
                                         spec.window.count));
        }
      }
    }
  }

  void addExtrema(const ExtremaFeatureSpec& spec) {
    extrema_ = true;
    entries_.push_back(fmt::format("BLOCK_EXTREMA, {}, {}, {}, {:d}, {:d}, {}, {}, {}, {}", spec.peaks,
                                   addWindow(spec.output.text, spec.window), spec.window.count,
                                   spec.kind != ExtremaKind::kMinima, spec.kind != ExtremaKind::kMaxima,
                                   spec.fit_samples, toC(spec.window.start), toC(spec.window.interval),
                                   toC(spec.prominence.value_or(0.0))));
  }

  const ResponseLayout& layout_;
  std::vector<int> starts_, rows_, window_rows_;
  std::vector<double> weights_;
  std::vector<std::string> entries_;
  bool statistics_ = false, extrema_ = false;
};

}  // namespace

void addGrid(const ExportedModel& model, CTables& tables, CSizes& sizes) {
  const Eigen::VectorXd& times = model.layout.times;
  const Index count = times.size();
  const double smallest = count < 2 ? 1e300 : (times.tail(count - 1) - times.head(count - 1)).minCoeff();
  tables.addWide("grid_times", times,
                 "Times of the grid on which signals are resampled, s; 0 is the model's.");
  tables.addNumber("grid_interval", model.sample_interval.value_or(smallest),
                   "The smallest interval at which a feature samples the signals, s.");
  sizes.push_back({"GRID", static_cast<long>(count), "times at which signals are needed"});
}

void addFeatures(const ExportedModel& model, CTables& tables, CSizes& sizes) {
  Blocks blocks(model.layout);
  ExperimentSpec one = model.experiment;
  for (const FeatureSpec& feature : model.experiment.features) {
    one.features = splitComplex({feature});
    blocks.add(feature, makeExtractor(one, model.layout));
  }
  blocks.write(tables, sizes);
}

}  // namespace twinmap
