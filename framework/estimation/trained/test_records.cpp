#include "framework/estimation/trained/test_records.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "framework/estimation/levels.hpp"

namespace twinmap {

bool CoverageRecord::isShort() const {
  constexpr double kProbability = 0.95, kTolerated = 0.92;
  if (tested == 0 || share.size() == 0 || share.minCoeff() >= kTolerated) {
    return false;
  }
  const auto samples = static_cast<double>(tested);
  const boost::math::binomial held(samples, kProbability);
  return cdf(held, std::round(share.minCoeff() * samples)) < kRareLevel / static_cast<double>(share.size());
}

std::vector<Eigen::Index> findUneven(const Eigen::VectorXd& p_value) {
  const double least = kRareLevel / static_cast<double>(p_value.size());
  std::vector<Eigen::Index> found;
  for (Eigen::Index q = 0; q < p_value.size(); ++q) {
    if (p_value[q] < least) {
      found.push_back(q);
    }
  }
  return found;
}

std::vector<Eigen::Index> RankRecord::listUneven() const {
  return findUneven(p_value);
}

}  // namespace twinmap
