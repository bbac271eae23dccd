#include "framework/optimal_design/candidate_information.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Whether noise goes along between features of different candidates.
bool isCoupled(const NoiseCovariance& covariance, const std::vector<std::vector<Index>>& groups) {
  if (covariance.isDiagonal()) {
    return false;
  }
  std::vector<Index> candidate(static_cast<std::size_t>(covariance.size()), -1);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const Index row : groups[g]) {
      candidate[static_cast<std::size_t>(row)] = static_cast<Index>(g);
    }
  }
  for (Index j = 0; j < covariance.size(); ++j) {
    for (Index i = 0; i < j; ++i) {
      if (covariance(i, j) != 0.0 &&
          candidate[static_cast<std::size_t>(i)] != candidate[static_cast<std::size_t>(j)]) {
        return true;
      }
    }
  }
  return false;
}

std::vector<MatrixXd> calcOf(const CandidateFeatures& features, const std::vector<Index>& rows) {
  const NoiseWhitener whitener(features.noise_covariance.take(rows));
  std::vector<MatrixXd> informations;
  for (const MatrixXd& sensitivities : features.sensitivities) {
    informations.push_back(calcFisherInformation(whitener, sensitivities(rows, Eigen::all)));
  }
  return informations;
}

Subset with(Subset subset, Index candidate) {
  subset.insert(std::lower_bound(subset.begin(), subset.end(), candidate), candidate);
  return subset;
}

Subset without(Subset subset, std::size_t position) {
  subset.erase(subset.begin() + static_cast<std::ptrdiff_t>(position));
  return subset;
}

struct Choice {
  Subset subset;
  double cost = std::numeric_limits<double>::infinity();
};

/// What a search for a subset works with.
struct SubsetSearch {
  const CandidateInformation& candidates;
  const Criterion& criterion;
  const std::function<void()>& proceed;

  /// The best of the subsets with one candidate more.
  Choice addBest(const Subset& subset) const {
    Choice best;
    proceed();
    for (Index c = 0; c < candidates.countCandidates(); ++c) {
      if (std::binary_search(subset.begin(), subset.end(), c)) {
        continue;
      }
      Subset tried = with(subset, c);
      if (const double cost = candidates.calcMeanCost(tried, criterion); cost < best.cost) {
        best = {std::move(tried), cost};
      }
    }
    if (best.subset.empty()) {
      throw std::runtime_error("what the candidates tell about the parameters is not finite");
    }
    return best;
  }

  /// The best exchange, if one is better by more than rounding.
  bool exchange(Choice& choice) const {
    constexpr double kRounding = 1e-9;
    bool improved = false;
    const Subset subset = choice.subset;
    for (std::size_t i = 0; i < subset.size(); ++i) {
      const Choice tried = addBest(without(subset, i));
      if (tried.cost < choice.cost - kRounding) {
        choice = tried;
        improved = true;
      }
    }
    return improved;
  }
};

}  // namespace

CandidateInformation::CandidateInformation(CandidateFeatures features, std::vector<std::vector<Index>> groups,
                                           Index parameters)
    : features_(std::move(features)), groups_(std::move(groups)), parameters_(parameters) {
  if (isCoupled(features_.noise_covariance, groups_)) {
    return;
  }
  for (const std::vector<Index>& rows : groups_) {
    own_.push_back(calcOf(features_, rows));
  }
}

/// Of all unknowns, at each point.
std::vector<MatrixXd> CandidateInformation::calcWhole(const Subset& subset) const {
  if (own_.empty()) {
    std::vector<Index> rows;
    for (const Index candidate : subset) {
      const std::vector<Index>& group = groups_[static_cast<std::size_t>(candidate)];
      rows.insert(rows.end(), group.begin(), group.end());
    }
    return calcOf(features_, rows);
  }
  std::vector<MatrixXd> sums;
  for (std::size_t point = 0; point < countPoints(); ++point) {
    const Index unknown = features_.sensitivities[point].cols();
    MatrixXd sum = MatrixXd::Zero(unknown, unknown);
    for (const Index candidate : subset) {
      sum += own_[static_cast<std::size_t>(candidate)][point];
    }
    sums.push_back(std::move(sum));
  }
  return sums;
}

MatrixXd CandidateInformation::calcInformation(const Subset& subset, std::size_t point) const {
  return calcMarginalInformation(calcWhole(subset)[point], parameters_);
}

double CandidateInformation::calcMeanCost(const Subset& subset, const Criterion& criterion) const {
  constexpr double kHalfWidths = 4.0;  // information per width^2 over that per half-width^2
  const MatrixXd prior = kHalfWidthInformation * MatrixXd::Identity(parameters_, parameters_);
  double sum = 0.0;
  for (const MatrixXd& whole : calcWhole(subset)) {
    sum += calcCost(criterion, calcMarginalInformation(whole, parameters_) / kHalfWidths + prior);
  }
  return sum / static_cast<double>(countPoints());
}

Subset extendSubset(const CandidateInformation& candidates, const Criterion& criterion, Subset begun,
                    Index count, const std::function<void()>& proceed) {
  const SubsetSearch search{candidates, criterion, proceed};
  Choice choice{std::move(begun)};
  while (static_cast<Index>(choice.subset.size()) < count) {
    choice = search.addBest(choice.subset);
  }
  while (search.exchange(choice)) {
  }
  return choice.subset;
}

}  // namespace twinmap::experiment_design
