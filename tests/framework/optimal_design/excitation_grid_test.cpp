// The search against an exhaustive grid of two free values, on the two beams.
#include <gtest/gtest.h>

#include <algorithm>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/optimal_design/design_search.hpp"
#include "tests/case_turns.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

YamlNode loadTree() {
  return loadExperimentTree(
      std::string(TWINMAP_SOURCE_DIR) + "/experiments/two_beam/design.yaml",
      {"design.excitation.free={'M.pulses[0].amplitude': [0, 0.075], 'M.pulses[0].end': [0.22, 0.4]}"});
}

class Grid : public ::testing::Test {
 protected:
  Grid() : tree_(loadTree()), evaluator_(makeEvaluator()), points_(makePoints()) {
    for (const Limit& limit : evaluator_.getLimits()) {
      most_.conservativeResize(most_.size() + 1);
      most_[most_.size() - 1] = limit.most;
    }
  }

  ExcitationEvaluator makeEvaluator() {
    const auto numbers = resolveFreeNumbers(readExperiment(tree_).design.excitation->free, tree_);
    return {tree_, numbers, 2};
  }

  MatrixXd makePoints() const {
    const ExperimentSpec& experiment = evaluator_.getExperiment();
    return samplePoints({DesignMethod::kLatinHypercube, 4, {}}, collectSampled(experiment.model), 1,
                        RandomPurpose::kDesignPoints);
  }

  DesignScore judge(const VectorXd& point) const {
    return evaluator_.calcScore(calcValues(evaluator_.getNumbers(), point), points_);
  }

  double searchGrid(int size) const {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= size; ++i) {
      for (int j = 0; j <= size; ++j) {
        const DesignScore score = judge(Eigen::Vector2d(double(i) / size, double(j) / size));
        best = calcViolation(score, most_) <= 0.0 ? std::min(best, score.cost) : best;
      }
    }
    return best;
  }

  YamlNode tree_;
  ExcitationEvaluator evaluator_;
  MatrixXd points_;
  VectorXd most_;
};

TEST_F(Grid, IsReachedFromAtLeastEightOfTenSeeds) {
  constexpr double kOnePercent = 0.02;  // of a standard deviation, in log variance
  const double grid = searchGrid(24);
  std::vector<double> found;
  for (const int i : twinmap::testing::takeTurn(10)) {
    const std::uint64_t seed = 1 + static_cast<std::uint64_t>(i);
    DesignSearch search([this](const VectorXd& point) { return judge(point); }, most_, {80, false, seed});
    search.run(calcPresentPoint(evaluator_.getNumbers()));
    ASSERT_NE(search.findBest(), nullptr);
    found.push_back(search.findBest()->score.cost);
  }
  const double best = *std::min_element(found.begin(), found.end());
  RecordProperty("grid", std::to_string(grid));
  RecordProperty("best", std::to_string(best));
  EXPECT_LT(best, grid + kOnePercent);
  const auto missed = std::count_if(found.begin(), found.end(),
                                    [&](double cost) { return cost >= std::min(best, grid) + kOnePercent; });
  EXPECT_LE(missed, 2) << ::testing::PrintToString(found);
}

}  // namespace
}  // namespace twinmap::experiment_design
