#include "framework/base/random/standard_normal.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/erf.hpp>

namespace twinmap {

double toStandardNormal(double uniform) {
  using boost::math::policies::make_policy;
  const auto in_double = make_policy(boost::math::policies::promote_double<false>());
  return -boost::math::constants::root_two<double>() * boost::math::erfc_inv(2.0 * uniform, in_double);
}

}  // namespace twinmap
