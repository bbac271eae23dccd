#include "framework/estimation/ridges/sum_coordinates.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXi;

namespace {

double calcLargest(const Combination& combination, const std::vector<ParameterSpec>& unknown) {
  VectorXd sizes(static_cast<Index>(unknown.size()));
  for (std::size_t j = 0; j < unknown.size(); ++j) {
    const Bounds& bounds = unknown[j].bounds;
    sizes[static_cast<Index>(j)] = std::max(std::abs(bounds.lower), std::abs(bounds.upper));
  }
  Combination absolute = combination;
  for (double& coefficient : absolute.coefficients) {
    coefficient = std::abs(coefficient);
  }
  return calcValue(absolute, sizes);
}

bool contains(const Combination& combination, Index parameter) {
  return std::any_of(combination.terms.begin(), combination.terms.end(),
                     [&](const VectorXi& term) { return term[parameter] != 0; });
}

bool isAlone(const VectorXi& term, Index parameter) {
  return term[parameter] == 1 && term.cwiseAbs().sum() == 1;
}

/// How many terms of all combinations contain a parameter.
int countTerms(const std::vector<Combination>& combinations, Index parameter) {
  int count = 0;
  for (const Combination& combination : combinations) {
    for (const VectorXi& term : combination.terms) {
      count += term[parameter] != 0 ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

std::vector<SumCoordinates::Sum> SumCoordinates::listSums(const std::vector<ParameterSpec>& unknown,
                                                          const std::vector<Ridge>& ridges) {
  std::vector<Sum> sums;
  for (const Ridge& ridge : ridges) {
    for (const Combination& combination : ridge.combinations) {
      for (std::size_t k = 0; combination.terms.size() > 1 && k < combination.terms.size(); ++k) {
        Index replaced = 0;
        combination.terms[k].cwiseAbs().maxCoeff(&replaced);
        const bool is_taken = std::any_of(sums.begin(), sums.end(), [&](const Sum& sum) {
          return sum.replaced == replaced || contains(combination, sum.replaced);
        });
        if (!is_taken && isAlone(combination.terms[k], replaced) &&
            countTerms(ridge.combinations, replaced) == 1) {
          sums.push_back(
              {combination, replaced, combination.coefficients[k], calcLargest(combination, unknown)});
          break;
        }
      }
    }
  }
  return sums;
}

std::vector<Index> SumCoordinates::listReplaced(const std::vector<ParameterSpec>& unknown,
                                                const std::vector<Ridge>& ridges) {
  std::vector<Index> replaced;
  for (const Sum& sum : listSums(unknown, ridges)) {
    replaced.push_back(sum.replaced);
  }
  return replaced;
}

SumCoordinates::SumCoordinates(const std::vector<ParameterSpec>& unknown, const std::vector<Ridge>& ridges)
    : sums_(listSums(unknown, ridges)), coordinates_(unknown, listReplaced(unknown, ridges)) {}

VectorXd SumCoordinates::toSums(const VectorXd& v) const {
  const VectorXd point = coordinates_.toParameters(v);
  VectorXd z = v;
  for (const Sum& sum : sums_) {
    z[sum.replaced] = calcValue(sum.combination, point) / sum.largest;
  }
  return z;
}

VectorXd SumCoordinates::fromSums(const VectorXd& z) const {
  VectorXd v = z;
  for (const Sum& sum : sums_) {
    v[sum.replaced] = 0.0;
  }
  const VectorXd point = coordinates_.toParameters(v);
  for (const Sum& sum : sums_) {
    const double rest = sum.largest * z[sum.replaced] - calcValue(sum.combination, point);
    v[sum.replaced] = rest / (sum.coefficient * coordinates_.getHalfWidths()[sum.replaced]);
  }
  return v;
}

MatrixXd SumCoordinates::calcSlopes(const VectorXd& v) const {
  const VectorXd point = coordinates_.toParameters(v);
  const VectorXd of_parameters = coordinates_.getHalfWidths().cwiseProduct(coordinates_.calcSlopes(v));
  MatrixXd slopes = MatrixXd::Identity(v.size(), v.size());
  for (const Sum& sum : sums_) {  // those of v with respect to one another at the same sum
    const VectorXd of_sum = calcGradient(sum.combination, point).cwiseProduct(of_parameters);
    slopes.row(sum.replaced) = -of_sum / of_sum[sum.replaced];
    slopes(sum.replaced, sum.replaced) = sum.largest / of_sum[sum.replaced];
  }
  return slopes;
}

}  // namespace twinmap
