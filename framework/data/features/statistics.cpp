#include "framework/data/features/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "framework/data/features/layout_rows.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

struct Quantity {
  Statistic statistic;
  std::vector<Index> rows;
};

double calcStatistic(Statistic statistic, const ArrayXd& values) {
  switch (statistic) {
    case Statistic::kMean:
      return values.mean();
    case Statistic::kStddev:
      return std::sqrt((values - values.mean()).square().sum() / (static_cast<double>(values.size()) - 1.0));
    case Statistic::kRms:
      return std::sqrt(values.square().mean());
    case Statistic::kMin:
      return values.minCoeff<Eigen::PropagateNaN>();
    case Statistic::kMax:
      return values.maxCoeff<Eigen::PropagateNaN>();
    case Statistic::kPeakToPeak:
      break;
  }
  return values.maxCoeff<Eigen::PropagateNaN>() - values.minCoeff<Eigen::PropagateNaN>();
}

class StatisticsBlock final : public FeatureBlock {
 public:
  StatisticsBlock(std::vector<FeatureInfo> infos, std::vector<Quantity> quantities)
      : FeatureBlock(std::move(infos)), quantities_(std::move(quantities)) {}

  void extract(const Eigen::Ref<const Eigen::MatrixXd>& responses,
               Eigen::Ref<Eigen::MatrixXd> features) const override {
    for (Index sample = 0; sample < responses.cols(); ++sample) {
      for (std::size_t i = 0; i < quantities_.size(); ++i) {
        features(static_cast<Index>(i), sample) =
            calcStatistic(quantities_[i].statistic, responses(quantities_[i].rows, sample).array());
      }
    }
  }

 private:
  std::vector<Quantity> quantities_;
};

/// "mean y(0.1 s to 2 s)"
FeatureInfo makeStatisticInfo(Statistic statistic, const ResponseLayout& layout, Index output,
                              const WindowSpec& window) {
  char span[64];
  std::snprintf(span, sizeof span, "(%.6g s to %.6g s)", calcSampleTime(window, 0),
                calcSampleTime(window, window.count - 1));
  return {std::string(getEnumText(statistic)) + " " + layout.output_names[output] + span,
          layout.output_units[output], static_cast<int>(output), 0.0};
}

std::shared_ptr<const FeatureBlock> makeMeans(const StatisticsFeatureSpec& spec,
                                              const ResponseLayout& layout) {
  std::vector<FeatureInfo> infos;
  FeatureMatrix matrix(static_cast<Index>(spec.outputs.size()), layout.getRowCount());
  for (const Name& name : spec.outputs) {
    const Index output = findOutput(layout, name.text);
    for (const Index row : findRows(layout, output, spec.window)) {
      matrix.insert(static_cast<Index>(infos.size()), row) = 1.0 / spec.window.count;
    }
    infos.push_back(makeStatisticInfo(Statistic::kMean, layout, output, spec.window));
  }
  return std::make_shared<LinearBlock>(std::move(infos), matrix);
}

}  // namespace

std::vector<std::shared_ptr<const FeatureBlock>> makeStatisticsBlocks(const StatisticsFeatureSpec& spec,
                                                                      const ResponseLayout& layout) {
  std::vector<std::shared_ptr<const FeatureBlock>> blocks;
  const auto& wanted = spec.quantities;
  if (std::find(wanted.begin(), wanted.end(), Statistic::kMean) != wanted.end()) {
    blocks.push_back(makeMeans(spec, layout));
  }
  std::vector<FeatureInfo> infos;
  std::vector<Quantity> quantities;
  for (const Name& name : spec.outputs) {
    const Index output = findOutput(layout, name.text);
    for (const Statistic statistic : wanted) {
      if (statistic != Statistic::kMean) {
        infos.push_back(makeStatisticInfo(statistic, layout, output, spec.window));
        quantities.push_back({statistic, findRows(layout, output, spec.window)});
      }
    }
  }
  if (!infos.empty()) {
    blocks.push_back(std::make_shared<StatisticsBlock>(std::move(infos), std::move(quantities)));
  }
  return blocks;
}

}  // namespace twinmap
