#pragma once

#include <cstddef>
#include <cstdint>

namespace twinmap {

/// What random numbers are for. Each purpose has its own stream, so that asking more of one changes no other.
enum class RandomPurpose : std::uint64_t {
  kTrainDesign = 1,
  kTestDesign = 2,
  kTrainNoise = 3,
  kTestNoise = 4,
  kSingleNoise = 5,      // one simulation on request
  kNoiseCovariance = 6,  // how noise propagates into features that are not linear
  kPosterior = 7,
  kBootstrap = 8,
  kVerification = 9,
  kTrust = 10,                // simulated measurements that real ones are compared with
  kEnsemble = 11,             // parameters drawn from what was inferred
  kNoiseAnomaly = 12,         // noise that refined answers are compared with
  kTrustPower = 13,           // measurements of a machine that differs from the model
  kSelftest = 14,             // measurements that exported code is tested with
  kSurrogatePosterior = 15,   // importance sampling under a surrogate
  kPosteriorResampling = 16,  // which of its draws are taken
  kNetworkWeights = 20,
  kNetworkBatches = 21,  // which samples a training step sees
  kNetworkNoise = 22,    // and with what noise
  kNetworkPool = 23,     // parameter points whose features a surrogate makes up
  kDesignPoints = 24,    // of the box, that an excitation is designed for
  kDesignStarts = 25,    // excitations that a search begins from
  kDesignCheck = 26,     // points at which the limits of a design are checked
  kJointCoverage = 27,   // of mixtures, whose highest-density sets are counted
  kNetworkChains = 28,   // along which a network's weights are sampled
  kBasinStarts = 29,     // where searches of a measurement's basins begin
  kAgreement = 30,       // errors that the disagreement of measurements is compared with
  kPriorPoints = 31,     // test points in place of those that bounds cut off
  kCourse = 32,          // errors that a change over measurements is compared with
  kPosteriorWalk = 33,   // chains through valleys that importance sampling does not cover
  kReduction = 34,       // points and columns that samples are reduced by
  kPriorTraining = 40,   // training points in place of those that bounds cut off
  kPriorPool = 41,       // and points of a surrogate's pool
};

/// Counter-based random numbers (Philox 4x64-10, Salmon et al. 2011): a number depends on
/// (seed, purpose, sample, channel, replicate) alone, never on the order or the thread of the calls.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose) : seed_(seed), purpose_(purpose) {}

  /// Uniform on the open interval (0, 1).
  double calcUniform(std::uint64_t sample, std::uint64_t channel, std::uint64_t replicate = 0) const;

  /// Standard normal, by the inverse of its distribution function at calcUniform().
  double calcNormal(std::uint64_t sample, std::uint64_t channel, std::uint64_t replicate = 0) const;

  /// `count` of them for (sample, replicate), other numbers than calcNormal()'s and twenty times as fast, for
  /// whoever needs many: by the ziggurat (Marsaglia, Tsang 2000), a word of the generator's block of four
  /// each, and words of its own where that is rejected (2 of 100). That of a channel depends on neither
  /// `count` nor the other channels; the bits are the same on all processors.
  void drawNormals(std::uint64_t sample, std::uint64_t replicate, double* values, std::size_t count) const;

 private:
  std::uint64_t seed_;
  RandomPurpose purpose_;
};

}  // namespace twinmap
