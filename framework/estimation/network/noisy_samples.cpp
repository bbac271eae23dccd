#include "framework/estimation/network/noisy_samples.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Noise of responses takes a replicate alone, so that this tells batches and their columns apart.
constexpr std::uint64_t kColumns = std::uint64_t{1} << 20;

}  // namespace

void NormalSamples::draw(const std::vector<Index>& chosen, const RandomStream& random, const NoiseKey& key,
                         Eigen::Ref<MatrixXd> inputs) const {
  const Index k = inputs_.factor.rows(), r = inputs_.error_projection.cols();
  MatrixXd normal(k + r, static_cast<Index>(chosen.size()));
  for (Index i = 0; i < normal.cols(); ++i) {
    random.drawNormals(static_cast<std::uint64_t>(key.first + i), key.batch, normal.col(i).data(),
                       static_cast<std::size_t>(normal.rows()));
  }
  inputs = inputs_.clean(Eigen::all, chosen);
  inputs.topRows(k).noalias() += inputs_.factor * normal.topRows(k);
  if (r > 0) {
    const MatrixXd error =
        inputs_.error_stddev(Eigen::all, chosen).cwiseProduct(inputs_.error_factor * normal.bottomRows(r));
    inputs.topRows(k).noalias() += inputs_.error_projection * error;
  }
}

void ResponseSamples::draw(const std::vector<Index>& chosen, const RandomStream& random, const NoiseKey& key,
                           Eigen::Ref<MatrixXd> inputs) const {
  const MatrixXd clean = responses_(Eigen::all, chosen);
  const std::uint64_t replicate = key.batch * kColumns + static_cast<std::uint64_t>(key.first);
  MatrixXd features = extractor_.extract(noise_.add(clean, random, replicate));
  for (Index i = 0; i < features.cols(); ++i) {
    if (!features.col(i).allFinite()) {
      features.col(i) = extractor_.extract(clean.col(i));
    }
  }
  const MatrixXd known = known_.rows() > 0 ? MatrixXd(known_(Eigen::all, chosen)) : MatrixXd();
  inputs = inputs_.apply(features, known);
}

}  // namespace twinmap
