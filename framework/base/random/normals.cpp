#include <Random123/philox.h>

#include <boost/random/normal_distribution.hpp>
#include <cstdint>
#include <limits>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Block = r123::Philox4x64;

// The last word of a counter: 0 is calcUniform()'s, then come a block of four channels, and those of a
// channel whose first word was rejected.
constexpr std::uint64_t kOfFour = 1, kOfRejected = 2;

/// The random words of one channel: the first is given, those after a rejection are its own blocks.
class ChannelWords {
 public:
  using result_type = std::uint64_t;

  ChannelWords(std::uint64_t first, const Block::ctr_type& rejected, const Block::key_type& key)
      : first_(first), counter_(rejected), key_(key) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()() {
    const std::uint64_t taken = taken_++;
    return taken == 0 ? first_ : drawAnother(taken - 1);
  }

 private:
  result_type drawAnother(std::uint64_t word) {
    Block::ctr_type counter = counter_;
    counter[3] += word / counter.size();
    return Block()(counter, key_)[word % counter.size()];
  }

  std::uint64_t first_, taken_ = 0;
  const Block::ctr_type& counter_;
  const Block::key_type& key_;
};

}  // namespace

void RandomStream::drawNormals(std::uint64_t sample, std::uint64_t replicate, double* values,
                               std::size_t count) const {
  boost::random::normal_distribution<double> normal;
  const Block::key_type key{{seed_, static_cast<std::uint64_t>(purpose_)}};
  constexpr std::size_t kWords = 4;
  for (std::size_t first = 0; first < count; first += kWords) {
    const auto words = Block()({{sample, first / kWords, replicate, kOfFour}}, key);
    for (std::size_t i = first; i < count && i < first + kWords; ++i) {
      const Block::ctr_type rejected{{sample, i, replicate, kOfRejected}};
      ChannelWords channel(words[i - first], rejected, key);
      values[i] = normal(channel);
    }
  }
}

}  // namespace twinmap
