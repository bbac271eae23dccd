#include "framework/estimation/network/network_map.hpp"

#include <stdexcept>

#include "framework/data/features/labelled_features.hpp"
#include "framework/estimation/run_tasks.hpp"

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

Mixture takeMixture(const network::Predictor::Workspace& predicted) {
  Mixture mixture{predicted.weights, predicted.means, predicted.means, {}};
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    const MatrixXd& covariance = predicted.covariances[static_cast<std::size_t>(c)];
    mixture.stddevs.col(c) = covariance.diagonal().cwiseSqrt();
    mixture.correlations.push_back(calcCorrelation(covariance));
  }
  return mixture;
}

Estimates predictTargets(const std::vector<network::Member>& members, const MatrixXd& inputs, int threads) {
  const network::Network& network = members.front().network;
  const network::EnsemblePredictor predictor(members);
  const Index n = inputs.cols(), p = network.countTargets();
  Estimates predictions{MatrixXd(p, n), MatrixXd(p, n), std::vector<MatrixXd>(static_cast<std::size_t>(n))};
  const bool mixed = network.countComponents() > 1;
  predictions.mixtures.resize(static_cast<std::size_t>(mixed ? n : 0));
  runChunks(threads, n, [&](Index first, Index end) {
    network::EnsemblePredictor::Workspace workspace(predictor);
    for (Index i = first; i < end; ++i) {
      const network::Predictor::Workspace& predicted = predictor.predict(inputs.col(i), workspace);
      predictions.mean.col(i) = predicted.mean;
      predictions.stddev.col(i) = predicted.stddev;
      predictions.correlations[static_cast<std::size_t>(i)] = calcCorrelation(predicted.covariance);
      if (mixed) {
        predictions.mixtures[static_cast<std::size_t>(i)] = takeMixture(predicted);
      }
    }
  });
  return predictions;
}

Estimates NetworkMap::convertTargets(Estimates predictions, const Eigen::VectorXd& stddev_scale) const {
  convert(center, half_width, stddev_scale, predictions);
  shrinkToBounds(center, half_width, predictions);
  return predictions;
}

Estimates NetworkMap::predict(const MatrixXd& features, const MatrixXd& known_values, int threads) const {
  Estimates predictions = convertTargets(
      predictTargets(members, inputs.apply(features, known_values), threads), validation.stddev_scale);
  predictions.interval_factors = replicate(validation.interval_factors, features.cols());
  return predictions;
}

}  // namespace twinmap
