#include "framework/base/random/random.hpp"

#include <Random123/philox.h>

#include <Random123/uniform.hpp>

#include "framework/base/random/standard_normal.hpp"

namespace twinmap {

double RandomStream::calcUniform(std::uint64_t sample, std::uint64_t channel, std::uint64_t replicate) const {
  const r123::Philox4x64::ctr_type counter{{sample, channel, replicate, 0}};
  const r123::Philox4x64::key_type key{{seed_, static_cast<std::uint64_t>(purpose_)}};
  return r123::u01fixedpt<double>(r123::Philox4x64()(counter, key)[0]);
}

double RandomStream::calcNormal(std::uint64_t sample, std::uint64_t channel, std::uint64_t replicate) const {
  return toStandardNormal(calcUniform(sample, channel, replicate));
}

}  // namespace twinmap
