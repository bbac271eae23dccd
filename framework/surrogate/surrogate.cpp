#include "framework/surrogate/surrogate.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/surrogate/run_tasks.hpp"
#include "framework/surrogate/score_inversion.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const char* toString(SurrogateStatus status) {
  return status == SurrogateStatus::kOk ? "ok" : "map_limited";
}

Predictions Surrogate::predict(const MatrixXd& features, const MatrixXd& inputs, int threads) const {
  constexpr Index kChunk = 16;  // measurements that share buffers
  const Index n = features.cols(), known = center.size() - unknown;
  if (features.rows() != forward.center.size() || inputs.rows() != known ||
      (known > 0 && inputs.cols() != n)) {
    throw std::invalid_argument("a surrogate needs all features, and all known inputs");
  }
  const MatrixXd scores = forward.calcScores(features);
  Predictions predictions{MatrixXd(parameters, n), MatrixXd(parameters, n)};
  runTasks(threads, static_cast<std::size_t>((n + kChunk - 1) / kChunk), [&](std::size_t chunk) {
    ScoreInversion inversion(forward, unknown);
    const Index first = static_cast<Index>(chunk) * kChunk;
    for (Index i = first; i < std::min(n, first + kChunk); ++i) {
      const VectorXd at =
          known > 0 ? VectorXd((inputs.col(i) - center.tail(known)).cwiseQuotient(half_width.tail(known)))
                    : VectorXd();
      const gp::Moments found = inversion.infer(scores.col(i), at);
      const auto widths = half_width.head(parameters).array();
      predictions.mean.col(i) =
          center.head(parameters).array() + widths * found.mean.head(parameters).array();
      predictions.stddev.col(i) = validation.stddev_scale.array() * widths *
                                  found.covariance.diagonal().head(parameters).array().sqrt();
    }
  });
  return predictions;
}

}  // namespace twinmap
