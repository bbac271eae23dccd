#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "framework/base/random/random.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/estimation/network/network_map.hpp"

namespace twinmap {

/// Which noise is drawn: that of a batch, whose columns from `first` on are asked for.
struct NoiseKey {
  std::uint64_t batch = 0;
  Eigen::Index first = 0;
};

/// Samples as a network's inputs, their noise drawn anew each time that they are asked for. Immutable.
class NoisySamples {
 public:
  virtual ~NoisySamples() = default;

  virtual Eigen::Index countInputs() const = 0;

  /// The inputs (one column each) of samples `chosen`. A column depends on its sample, the stream and the key
  /// alone; may be called from several threads.
  virtual void draw(const std::vector<Eigen::Index>& chosen, const RandomStream& random, const NoiseKey& key,
                    Eigen::Ref<Eigen::MatrixXd> inputs) const = 0;
};

/// Samples whose inputs have normal noise:
///   inputs = clean + factor z + error_projection (stddev * (error_factor z')),   z (k), z' (r) standard
///   normal,
/// the product with stddev (a column for each sample, r x n) element by element; without error the first two.
struct NormalInputs {
  Eigen::MatrixXd clean;             ///< k + q x n, the known inputs last
  Eigen::MatrixXd factor;            ///< k x k
  Eigen::MatrixXd error_projection;  ///< k x r, or empty like all of the error
  Eigen::MatrixXd error_stddev;      ///< r x n
  Eigen::MatrixXd error_factor;      ///< r x r
};

class NormalSamples final : public NoisySamples {
 public:
  explicit NormalSamples(NormalInputs inputs) : inputs_(std::move(inputs)) {}
  Eigen::Index countInputs() const override { return inputs_.clean.rows(); }
  void draw(const std::vector<Eigen::Index>& chosen, const RandomStream& random, const NoiseKey& key,
            Eigen::Ref<Eigen::MatrixXd> inputs) const override;

 private:
  NormalInputs inputs_;
};

/// Responses, of whose noise features follow that are not linear. Where a draw lacks a feature, the clean
/// response's stand in. What is referred to must outlive the object.
class ResponseSamples final : public NoisySamples {
 public:
  /// responses: rows x n, clean; known: q x n.
  ResponseSamples(const Eigen::MatrixXd& responses, const Eigen::MatrixXd& known,
                  const FeatureExtractor& extractor, const ResponseNoise& noise, const NetworkInputs& inputs)
      : responses_(responses), known_(known), extractor_(extractor), noise_(noise), inputs_(inputs) {}
  Eigen::Index countInputs() const override { return inputs_.countInputs(); }
  void draw(const std::vector<Eigen::Index>& chosen, const RandomStream& random, const NoiseKey& key,
            Eigen::Ref<Eigen::MatrixXd> inputs) const override;

 private:
  const Eigen::MatrixXd& responses_;
  const Eigen::MatrixXd& known_;
  const FeatureExtractor& extractor_;
  const ResponseNoise& noise_;
  const NetworkInputs& inputs_;
};

}  // namespace twinmap
