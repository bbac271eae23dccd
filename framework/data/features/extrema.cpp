#include "framework/data/features/extrema.hpp"

#include <limits>

#include "framework/data/features/layout_rows.hpp"
#include "framework/data/features/peaks.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

std::vector<double> getSigns(ExtremaKind kind) {
  switch (kind) {
    case ExtremaKind::kMaxima:
      return {1.0};
    case ExtremaKind::kMinima:
      return {-1.0};
    case ExtremaKind::kBoth:
      break;
  }
  return {1.0, -1.0};
}

class ExtremaBlock final : public FeatureBlock {
 public:
  ExtremaBlock(std::vector<FeatureInfo> infos, const ExtremaFeatureSpec& spec, std::vector<Index> rows)
      : FeatureBlock(std::move(infos)), spec_(spec), rows_(std::move(rows)) {}

  void extract(const Eigen::Ref<const Eigen::MatrixXd>& responses,
               Eigen::Ref<Eigen::MatrixXd> features) const override {
    features.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (Index sample = 0; sample < responses.cols(); ++sample) {
      Index first = 0;
      for (const double sign : getSigns(spec_.kind)) {
        write(sign, sign * responses(rows_, sample), features.col(sample).segment(first, 2 * spec_.peaks));
        first += 2 * spec_.peaks;
      }
    }
  }

 private:
  void write(double sign, const Eigen::VectorXd& values, Eigen::Ref<Eigen::VectorXd> features) const {
    Index row = 0;
    for (const Peak& peak :
         findPeaks(values, spec_.prominence.value_or(0.0), spec_.fit_samples, spec_.peaks)) {
      features[row++] = sign * peak.value;
      features[row++] = spec_.window.start + peak.position * spec_.window.interval;
    }
  }

  ExtremaFeatureSpec spec_;
  std::vector<Index> rows_;
};

}  // namespace

std::shared_ptr<const FeatureBlock> makeExtremaBlock(const ExtremaFeatureSpec& spec,
                                                     const ResponseLayout& layout) {
  const Index output = findOutput(layout, spec.output.text);
  std::vector<FeatureInfo> infos;
  for (const double sign : getSigns(spec.kind)) {
    for (int i = 1; i <= spec.peaks; ++i) {
      const std::string name =
          spec.output.text + (sign > 0.0 ? " maximum " : " minimum ") + std::to_string(i);
      infos.push_back({name + " value", layout.output_units[output], static_cast<int>(output), 0.0});
      infos.push_back({name + " time", "s", static_cast<int>(output), 0.0});
    }
  }
  return std::make_shared<ExtremaBlock>(std::move(infos), spec, findRows(layout, output, spec.window));
}

}  // namespace twinmap
