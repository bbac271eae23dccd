#include "framework/base/random/random.hpp"

#include <Random123/philox.h>

#include <Random123/uniform.hpp>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/erf.hpp>

namespace twinmap {

namespace {

double toNormal(double uniform) {
  using boost::math::policies::make_policy;
  const auto in_double = make_policy(boost::math::policies::promote_double<false>());
  return -boost::math::constants::root_two<double>() * boost::math::erfc_inv(2.0 * uniform, in_double);
}

}  // namespace

double RandomStream::calcUniform(std::uint64_t sample, std::uint64_t channel, std::uint64_t replicate) const {
  const r123::Philox4x64::ctr_type counter{{sample, channel, replicate, 0}};
  const r123::Philox4x64::key_type key{{seed_, static_cast<std::uint64_t>(purpose_)}};
  return r123::u01fixedpt<double>(r123::Philox4x64()(counter, key)[0]);
}

double RandomStream::calcNormal(std::uint64_t sample, std::uint64_t channel, std::uint64_t replicate) const {
  return toNormal(calcUniform(sample, channel, replicate));
}

}  // namespace twinmap
