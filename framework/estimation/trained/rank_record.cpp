#include "framework/estimation/trained/rank_record.hpp"

namespace twinmap {

using Eigen::Index;

std::vector<Index> findUneven(const Eigen::VectorXd& p_value) {
  constexpr double kChance = 1e-3;
  const double least = kChance / static_cast<double>(p_value.size());
  std::vector<Index> found;
  for (Index q = 0; q < p_value.size(); ++q) {
    if (p_value[q] < least) {
      found.push_back(q);
    }
  }
  return found;
}

std::vector<Index> RankRecord::listUneven() const {
  return findUneven(p_value);
}

}  // namespace twinmap
