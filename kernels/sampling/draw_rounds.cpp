#include "kernels/sampling/draw_rounds.hpp"

namespace twinmap::importance {

using Eigen::Index;

AdaptiveDraws drawInRounds(const std::function<Round(int round)>& draw, int most_rounds) {
  Round all;
  AdaptiveDraws drawn;
  bool goes_on = true;
  while (goes_on) {
    const Round more = draw(drawn.rounds);
    const Index before = all.points.cols(), count = before + more.points.cols();
    all.points.conservativeResize(more.points.rows(), count);
    all.points.rightCols(more.points.cols()) = more.points;
    all.log_weights.conservativeResize(count);
    all.log_weights.tail(more.points.cols()) = more.log_weights;
    ++drawn.rounds;
    drawn.draws = weigh(all.points, all.log_weights);
    drawn.effective_sample_size = calcEffectiveSampleSize(drawn.draws);
    const double reached = drawn.effective_sample_size / drawn.rounds * most_rounds;
    goes_on = drawn.rounds < most_rounds && drawn.effective_sample_size < kSmallestSampleSize &&
              reached >= kSmallestSampleSize;
  }
  drawn.pareto_shape = calcParetoShape(drawn.draws);
  return drawn;
}

}  // namespace twinmap::importance
