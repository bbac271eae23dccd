#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "framework/base/random/random.hpp"
#include "framework/data/features/feature_block.hpp"
#include "framework/data/features/noise_covariance.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// The noise's standard deviation of every row of a response, scale included. Readings that are rounded to
/// multiples of q have a variance of q^2 / 12 more (uniform from -q / 2 to q / 2).
Eigen::VectorXd calcNoiseStddev(const NoiseSpec& noise, const ResponseLayout& layout);

/// The noise of a response: normal, of a standard deviation of every row; independent, or correlated among
/// the rows of an output; and that of readings that are rounded, which is independent.
class ResponseNoise {
 public:
  /// Independent noise.
  template <class Derived>
  ResponseNoise(const Eigen::MatrixBase<Derived>& row_stddev) : stddev_(row_stddev), drawn_(row_stddev) {}

  /// That of an experiment. Rows of an output whose times are not multiples of its sample_time apart are
  /// independent: no feature of the output uses both. Throws std::invalid_argument where the correlation of
  /// the rows is not positive definite. Cost: t^3 / 3 for an output of t correlated times.
  ResponseNoise(const NoiseSpec& noise, const ResponseLayout& layout);

  /// Independent noise of these standard deviations in the places of some rows; NaN: as it is. Empty: all.
  /// Throws std::invalid_argument for a row whose noise is correlated with others.
  void replace(const Eigen::VectorXd& row_stddev);

  /// Adds what rows have in common (rows x r): independent unit normal numbers, each in its column's
  /// proportions. It counts in calcCovariance() alone. Without columns nothing changes.
  void share(const Eigen::MatrixXd& common) { common_ = common; }

  /// That of rounding included.
  const Eigen::VectorXd& getStddev() const { return stddev_; }

  /// Responses (rows x n) plus noise, then rounded. That of a response depends on the stream, its number and
  /// the replicate alone; the columns are numbered from `first` on.
  Eigen::MatrixXd add(const Eigen::MatrixXd& responses, const RandomStream& random, std::uint64_t replicate,
                      Eigen::Index first = 0) const;

  /// The covariance M C M' (d x d) of features = M * response; of independent rows linear in d where no two
  /// features use the same row.
  NoiseCovariance calcCovariance(const FeatureMatrix& matrix) const;

 private:
  /// Correlated rows: their noise but for rounding is stddev * (factor * independent standard normal
  /// numbers).
  struct Block {
    std::vector<Eigen::Index> rows;
    Eigen::MatrixXd factor;  ///< lower Cholesky factor of their correlation
  };
  NoiseCovariance calcOwnCovariance(const FeatureMatrix& matrix) const;
  void correlate(const NoiseCorrelationSpec& spec, const ResponseLayout& layout);

  Eigen::VectorXd stddev_, drawn_;  ///< with and without rounding
  Eigen::VectorXd quanta_;          ///< of each row, 0: not rounded; empty: none is
  std::vector<Block> blocks_;
  Eigen::MatrixXd common_;  ///< rows x r; empty: none
};

/// Responses (rows x n) plus noise (ResponseNoise::add).
Eigen::MatrixXd addNoise(const Eigen::MatrixXd& responses, const ResponseNoise& noise,
                         const RandomStream& random, std::uint64_t replicate = 0);

}  // namespace twinmap
