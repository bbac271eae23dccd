#include "framework/online/fit_trust.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/features/scaling_steps.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Neighbouring features of one output. Where whitening mixes the features to fewer numbers, one run.
std::vector<ResidualRun> collectRuns(const std::vector<FeatureInfo>& infos, Index residuals) {
  if (residuals != static_cast<Index>(infos.size())) {
    return {{0, residuals}};
  }
  std::vector<ResidualRun> runs;
  for (Index i = 0; i < residuals; ++i) {
    if (i == 0 || infos[i].output != infos[i - 1].output) {
      runs.push_back({i, 0});
    }
    ++runs.back().count;
  }
  return runs;
}

TrainingCloud makeCloud(const OnlineMap& map, const TrustTraining& training, const MatrixXd& known) {
  constexpr Index kMost = 1000;
  const Index n = std::min(training.points.cols(), kMost);
  TrainingCloud cloud;
  cloud.inputs = map.getMap().makeProcessInputs(training.clean_features.leftCols(n), known.leftCols(n));
  cloud.scale = fitZScore(cloud.inputs).scale;
  cloud.inputs = cloud.scale.cwiseInverse().asDiagonal() * cloud.inputs;
  return cloud;
}

void sort(VectorXd& values) {
  std::sort(values.data(), values.data() + values.size());
}

/// The statistics of the simulated measurements, by a model whose references are still empty. None depends on
/// the inferred standard deviation.
void fitReferences(const TrustTraining& training, const OnlineMap& map, TrustModel& model) {
  const Index count = training.measured.cols();
  model.chi_square.sorted.resize(count);
  model.burst.sorted.resize(count);
  OnlineMap::Workspace inferring(map);
  TrustWorkspace judging;
  double reach = 0.0;
  for (Index i = 0; i < count; ++i) {
    const auto features = training.measured.col(i);
    const auto known = training.known.col(i);
    const Trust trust = judge(model, features, known, map.inferMean(features, known, inferring), judging);
    model.chi_square.sorted[i] = trust.chi_square;
    model.burst.sorted[i] = trust.burst.score;
    reach = std::max(reach, trust.distance);
  }
  sort(model.chi_square.sorted);
  sort(model.burst.sorted);
  model.cloud.reach = reach > 0.0 ? reach : 1.0;
}

}  // namespace

TrustModel fitTrustModel(const TrustTraining& training, const OnlineMap& map, double level) {
  if (training.measured.cols() == 0) {
    throw std::invalid_argument("a trust model needs simulated measurements");
  }
  const VectorXd center = calcBoxCenter(training.sampled);
  const VectorXd half_width = 0.5 * calcWidths(training.sampled);
  const MatrixXd normalized = half_width.cwiseInverse().asDiagonal() * (training.points.colwise() - center);
  TrustModel model{fitForwardModel(normalized, training.clean_features, training.noise_covariance),
                   {},
                   {},
                   {},
                   makeCloud(map, training, training.points.bottomRows(training.known.rows())),
                   center,
                   half_width,
                   training.unknown,
                   level};
  model.runs = collectRuns(training.infos, model.forward.components.rows());
  fitReferences(training, map, model);
  return model;
}

}  // namespace twinmap
