#include "framework/network_map/network_map.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/features/labelled_features.hpp"
#include "framework/surrogate/run_tasks.hpp"
#include "kernels/network/predictor.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd NetworkInputs::apply(const MatrixXd& features, const MatrixXd& known_values) const {
  if (features.rows() != center.size() || known_values.rows() != known.center.size() ||
      (known_values.rows() > 0 && known_values.cols() != features.cols())) {
    throw std::invalid_argument("a network needs all features, and all known inputs");
  }
  const MatrixXd projected = projection * (features.colwise() - center);
  return known_values.rows() == 0 ? projected : stackRows(projected, known.scale(known_values));
}

Predictions predictTargets(const network::Network& network, const MatrixXd& inputs, int threads) {
  constexpr Index kChunk = 256;  // measurements that share buffers
  const network::Predictor predictor(network);
  const Index n = inputs.cols(), p = network.countTargets();
  Predictions predictions{MatrixXd(p, n), MatrixXd(p, n), std::vector<MatrixXd>(static_cast<std::size_t>(n))};
  runTasks(threads, static_cast<std::size_t>((n + kChunk - 1) / kChunk), [&](std::size_t chunk) {
    network::Predictor::Workspace workspace(predictor);
    const Index first = static_cast<Index>(chunk) * kChunk;
    for (Index i = first; i < std::min(n, first + kChunk); ++i) {
      predictor.predict(inputs.col(i), workspace);
      predictions.mean.col(i) = workspace.mean;
      predictions.stddev.col(i) = workspace.stddev;
      predictions.correlations[static_cast<std::size_t>(i)] = calcCorrelation(workspace.covariance);
    }
  });
  return predictions;
}

Predictions NetworkMap::predict(const MatrixXd& features, const MatrixXd& known_values, int threads) const {
  Predictions predictions = predictTargets(network, inputs.apply(features, known_values), threads);
  predictions.mean = (half_width.asDiagonal() * predictions.mean).colwise() + center;
  predictions.stddev = validation.stddev_scale.cwiseProduct(half_width).asDiagonal() * predictions.stddev;
  return predictions;
}

}  // namespace twinmap
