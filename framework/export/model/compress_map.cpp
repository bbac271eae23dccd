#include "framework/export/model/compress_map.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/source_location.hpp"
#include "kernels/gp/sparse/compression.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The transform as one matrix of floats on features less where they are on average, which costs few digits.
FeatureTransform roundTransform(const FeatureTransform& transform) {
  const VectorXd center = transform.steps.front().offset;
  const MatrixXd matrix = transform.calcMatrix().cast<float>().cast<double>();
  const AffineStep shift{-VectorXd(transform.apply(center)), VectorXd::Ones(matrix.rows()), {}};
  return {{makeProjection(center, matrix), shift}};
}

/// Null where it cannot be, or is not smaller.
gp::Process compressProcess(const gp::GaussianProcess& exact, double tolerance) {
  const auto sparse = gp::compress(exact, tolerance, gp::InputStorage::kSingle);
  if (!sparse) {
    return sparse;
  }
  gp::SparseGaussianProcessParts parts = sparse->getParts();
  MatrixXd& correction = parts.posterior.correction_factor;
  correction = correction.cast<float>().cast<double>().eval();
  return std::make_shared<const gp::SparseGaussianProcess>(std::move(parts));
}

struct Loss {
  double mean, stddev;
};

Loss calcLoss(const Estimates& before, const Estimates& after, Index parameter) {
  const auto sd = before.stddev.row(parameter).array();
  const auto moved = (after.mean.row(parameter) - before.mean.row(parameter)).array() / sd;
  const auto grown = after.stddev.row(parameter).array() / sd - 1.0;
  return {std::sqrt(moved.square().mean()), std::sqrt(grown.square().mean())};
}

}  // namespace

CompressedMap compressMap(const GpMap& exact, const CompressionTest& test, double most) {
  constexpr double kLoosest = 10.0, kTightest = 1e-5, kTighter = 0.5;  // of the noise variance
  const Estimates before = exact.predict(test.features, test.known);
  CompressedMap compressed{exact};
  compressed.map.transform = roundTransform(exact.transform);
  for (std::size_t p = 0; p < exact.processes.size(); ++p) {
    const auto* process = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&exact.processes[p]);
    bool found = false;
    for (double tolerance = kLoosest; process != nullptr && !found && tolerance > kTightest;
         tolerance *= kTighter) {
      const gp::Process candidate = compressProcess(**process, tolerance);
      if (std::get<std::shared_ptr<const gp::SparseGaussianProcess>>(candidate) == nullptr) {
        break;
      }
      compressed.map.processes[p] = candidate;
      const auto parameter = static_cast<Index>(p);
      const Loss loss = calcLoss(before, compressed.map.predict(test.features, test.known), parameter);
      found = loss.mean <= most && loss.stddev <= most;
      if (found) {
        compressed.mean_loss = std::max(compressed.mean_loss, loss.mean);
        compressed.stddev_loss = std::max(compressed.stddev_loss, loss.stddev);
      }
    }
    if (!found) {
      throw ExperimentError(fmt::format(
          "export --compress: process {} of {} cannot be compressed: {}; export without --compress, or train "
          "on fewer samples (design.train.samples)",
          p + 1, exact.processes.size(),
          process == nullptr
              ? "it has inducing inputs already"
              : fmt::format("with fewer inputs its estimates would move by more than {} sd", most)));
    }
  }
  return compressed;
}

}  // namespace twinmap
