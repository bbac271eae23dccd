#include "framework/estimation/trained/coverage_record.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <cmath>

namespace twinmap {

bool CoverageRecord::isShort() const {
  constexpr double kProbability = 0.95, kTolerated = 0.92, kChance = 1e-3;
  if (tested == 0 || share.size() == 0 || share.minCoeff() >= kTolerated) {
    return false;
  }
  const auto samples = static_cast<double>(tested);
  const boost::math::binomial held(samples, kProbability);
  return cdf(held, std::round(share.minCoeff() * samples)) < kChance / static_cast<double>(share.size());
}

}  // namespace twinmap
