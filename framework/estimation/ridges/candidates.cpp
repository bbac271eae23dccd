#include "framework/estimation/ridges/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXi;

namespace {

/// Calls `visit` with each ascending choice of `size` of the numbers 0 to count - 1.
void visitSubsets(Index count, Index size, const std::function<void(const std::vector<Index>&)>& visit) {
  std::vector<Index> chosen;
  const std::function<void(Index)> extend = [&](Index first) {
    if (static_cast<Index>(chosen.size()) == size) {
      visit(chosen);
      return;
    }
    for (Index j = first; j < count; ++j) {
      chosen.push_back(j);
      extend(j + 1);
      chosen.pop_back();
    }
  };
  extend(0);
}

/// Calls `visit` with all vectors of `size` numbers from -most to most without a zero.
void visitExponents(Index size, int most, const std::function<void(const VectorXi&)>& visit) {
  VectorXi exponents = VectorXi::Constant(size, -most);
  for (;;) {
    if ((exponents.array() != 0).all()) {
      visit(exponents);
    }
    Index j = 0;
    while (j < size && ++exponents[j] > most) {
      exponents[j++] = -most;
    }
    if (j == size) {
      return;
    }
  }
}

bool hasOneSign(const Bounds& bounds) {
  return bounds.lower > 0.0 || bounds.upper < 0.0;
}

bool isPrimitive(const VectorXi& exponents) {
  int divisor = 0;
  for (const int exponent : exponents) {
    divisor = std::gcd(divisor, exponent);
  }
  return divisor == 1;
}

/// Whether no divisor may be 0.
bool isDefined(const VectorXi& exponents, const std::vector<ParameterSpec>& parameters) {
  for (Index j = 0; j < exponents.size(); ++j) {
    if (exponents[j] < 0 && !hasOneSign(parameters[static_cast<std::size_t>(j)].bounds)) {
      return false;
    }
  }
  return true;
}

/// Of a product and its inverse the one whose first exponent is positive, or the only one that is defined.
bool isPreferred(const VectorXi& exponents, const std::vector<ParameterSpec>& parameters) {
  const bool starts_upright =
      *std::find_if(exponents.begin(), exponents.end(), [](int e) { return e != 0; }) > 0;
  return isDefined(exponents, parameters) && (starts_upright || !isDefined(-exponents, parameters));
}

/// Sums of powers and of terms are as hard to read as they are long; divisions slightly more.
double calcProductComplexity(const VectorXi& exponents) {
  return exponents.cwiseAbs().sum() + 0.1 * static_cast<double>((exponents.array() < 0).count());
}

/// One of 1, 2, 3, 4 and their inverses, where the number is near one; else its first three digits.
double roundCoefficient(double value) {
  for (const double simple : {1.0, 2.0, 0.5, 3.0, 1.0 / 3.0, 4.0, 0.25}) {
    if (std::abs(std::abs(value) - simple) < kMattersInSum * simple) {
      return std::copysign(simple, value);
    }
  }
  return roundToThreeDigits(value);
}

/// On the ridge of one measurement J + m L^2 is J + p L too, with the value p of m L there: units tell which
/// holds elsewhere.
double calcSumComplexity(const Combination& sum, const std::vector<ParameterSpec>& parameters) {
  constexpr double kOfUnits = 3.0;
  double complexity = hasOneUnit(sum, parameters) ? 1.0 : 1.0 + kOfUnits;
  for (std::size_t k = 0; k < sum.terms.size(); ++k) {
    const double coefficient = std::abs(sum.coefficients[k]);
    const bool is_simple =
        coefficient == std::round(coefficient) || 1.0 / coefficient == std::round(1.0 / coefficient);
    complexity += 1.0 + calcProductComplexity(sum.terms[k]) +
                  (coefficient == 1.0 ? 0.0
                   : is_simple        ? 1.0
                                      : 2.0);
  }
  return complexity - 1.0;
}

/// The products of powers that sums are made of: of one or two parameters, by their degree, 1 to 3.
std::vector<VectorXi> listTerms(const std::vector<Index>& group, Index parameters) {
  std::vector<VectorXi> terms;
  const auto add = [&](std::initializer_list<std::pair<Index, int>> powers) {
    VectorXi exponents = VectorXi::Zero(parameters);
    for (const auto& [parameter, power] : powers) {
      exponents[parameter] = power;
    }
    terms.push_back(exponents);
  };
  for (const Index a : group) {
    add({{a, 1}});
    add({{a, 2}});
    for (const Index b : group) {
      if (a < b) {
        add({{a, 1}, {b, 1}});
        add({{a, 1}, {b, 2}});
        add({{a, 2}, {b, 1}});
      }
    }
  }
  std::stable_sort(terms.begin(), terms.end(),
                   [](const VectorXi& a, const VectorXi& b) { return a.sum() < b.sum(); });
  return terms;
}

/// The gradients of terms, in widths, and what of them lies along the flat directions, over all points.
struct TermGradients {
  std::vector<VectorXi> terms;
  VectorXd scale;        ///< by which gradients were divided
  MatrixXd whole, flat;  ///< k x k: inner products summed over the points
};

TermGradients calcTermGradients(const FlatDirections& flat, const std::vector<ParameterSpec>& parameters) {
  const VectorXd widths = calcWidths(parameters);
  TermGradients result{listTerms(flat.parameters, widths.size()), {}, {}, {}};
  const auto count = static_cast<Index>(result.terms.size());
  const auto g = static_cast<Index>(flat.parameters.size()), n = flat.points.cols();
  MatrixXd whole(g * n, count), along(flat.dimension * n, count);
  for (Index k = 0; k < count; ++k) {
    for (Index i = 0; i < n; ++i) {
      const VectorXd gradient =
          calcProductGradient(result.terms[static_cast<std::size_t>(k)], flat.points.col(i))
              .cwiseProduct(widths)(flat.parameters);
      whole.col(k).segment(i * g, g) = gradient;
      along.col(k).segment(i * flat.dimension, flat.dimension) =
          flat.changes[static_cast<std::size_t>(i)].transpose() * gradient;
    }
  }
  result.scale = whole.colwise().norm();
  whole = whole * result.scale.cwiseInverse().asDiagonal();
  along = along * result.scale.cwiseInverse().asDiagonal();
  result.whole = whole.transpose() * whole;
  result.flat = along.transpose() * along;
  return result;
}

/// The best coefficients of a sum of terms; all of them matter, or it is another sum.
Combination fitSum(const TermGradients& gradients, const std::vector<Index>& chosen) {
  const MatrixXd flat = gradients.flat(chosen, chosen);
  const VectorXd best = linalg::calcSymmetricEigen(flat).vectors.col(0);
  Combination sum;
  sum.residual =
      std::sqrt(std::max(0.0, best.dot(flat * best)) / best.dot(gradients.whole(chosen, chosen) * best));
  if (best.cwiseAbs().minCoeff() < kMattersInSum * best.cwiseAbs().maxCoeff()) {
    sum.residual = 1.0;
  }
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    sum.terms.push_back(gradients.terms[static_cast<std::size_t>(chosen[k])]);
    sum.coefficients.push_back(best[static_cast<Index>(k)] / gradients.scale[chosen[k]]);
  }
  divideByFirst(sum);
  return sum;
}

void roundCoefficients(Combination& sum, const FlatDirections& flat,
                       const std::vector<ParameterSpec>& parameters) {
  Combination rounded = sum;
  for (double& coefficient : rounded.coefficients) {
    coefficient = roundCoefficient(coefficient);
  }
  rounded.residual = calcResidual(rounded, flat, parameters);
  sum.residual = calcResidual(sum, flat, parameters);
  if (rounded.residual < sum.residual + kExact) {
    sum = rounded;
  }
}

/// The weights of the columns `from` that are nearest to column `to`; `inner`: their inner products.
VectorXd solveFor(const MatrixXd& inner, const std::vector<Index>& from, Index to) {
  return from.empty() ? VectorXd() : linalg::solveMinimumNorm(inner(from, from), inner(from, to));
}

}  // namespace

double calcResidual(const Combination& combination, const FlatDirections& flat,
                    const std::vector<ParameterSpec>& parameters) {
  const VectorXd widths = calcWidths(parameters);
  double sum = 0.0;
  for (Index i = 0; i < flat.points.cols(); ++i) {
    const VectorXd gradient =
        calcGradient(combination, flat.points.col(i)).cwiseProduct(widths)(flat.parameters);
    sum += (flat.changes[static_cast<std::size_t>(i)].transpose() * gradient).squaredNorm() /
           gradient.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(flat.points.cols()));
}

bool isConstant(const Combination& combination, const FlatDirections& flat,
                const std::vector<ParameterSpec>& parameters) {
  constexpr double kShare = 0.05, kThreeTimes = 3.0;
  const VectorXd widths = calcWidths(parameters);
  const Index n = flat.points.cols();
  const auto count = static_cast<double>(n);
  VectorXd values(n);
  VectorXd squares = VectorXd::Zero(static_cast<Index>(flat.parameters.size()));  // of the gradients
  double unknown = 0.0;
  for (Index i = 0; i < n; ++i) {
    const VectorXd gradient = calcGradient(combination, flat.points.col(i))(flat.parameters);
    const VectorXd in_widths = gradient.cwiseProduct(widths(flat.parameters));
    values[i] = calcValue(combination, flat.points.col(i));
    squares += gradient.cwiseAbs2() / count;
    unknown += in_widths.dot(flat.determined[static_cast<std::size_t>(i)] * in_widths) / count;
  }
  const MatrixXd points = flat.points(flat.parameters, Eigen::all);
  const VectorXd variances = (points.colwise() - points.rowwise().mean()).cwiseAbs2().rowwise().mean();
  const double variance = (values.array() - values.mean()).square().mean();
  return variance <= kShare * kShare * squares.dot(variances) + kThreeTimes * kThreeTimes * unknown;
}

namespace {

/// How many products there are of so many of `count` parameters, each exponent from -most to most.
double countProducts(Index count, Index size, int most) {
  double products = 0.5;  // a product and its inverse are one
  for (Index k = 0; k < size; ++k) {
    products *= 2.0 * most * static_cast<double>(count - k) / static_cast<double>(k + 1);
  }
  return products;
}

}  // namespace

std::vector<Candidate> findProducts(const FlatDirections& flat, const std::vector<ParameterSpec>& parameters,
                                    double largest) {
  constexpr std::array<int, 3> kMost{4, 3, 2};  // exponents of two, three and four parameters
  constexpr double kProducts = 1e5;             // some seconds: four of 13 parameters, three of 18
  std::vector<Candidate> found;
  const auto g = static_cast<Index>(flat.parameters.size());
  for (std::size_t extra = 0; extra < kMost.size() && static_cast<Index>(extra) + 2 <= g; ++extra) {
    const auto size = static_cast<Index>(extra) + 2;
    if (countProducts(g, size, kMost[extra]) > kProducts) {
      break;
    }
    visitSubsets(g, size, [&](const std::vector<Index>& chosen) {
      visitExponents(size, kMost[extra], [&](const VectorXi& exponents) {
        if (!isPrimitive(exponents)) {
          return;
        }
        VectorXi all = VectorXi::Zero(static_cast<Index>(parameters.size()));
        for (Index k = 0; k < size; ++k) {
          const Index parameter =
              flat.parameters[static_cast<std::size_t>(chosen[static_cast<std::size_t>(k)])];
          all[parameter] = exponents[k];
        }
        if (!isPreferred(all, parameters)) {
          return;
        }
        Candidate candidate{{{all}, {1.0}, 0.0}, calcProductComplexity(all)};
        candidate.combination.residual = calcResidual(candidate.combination, flat, parameters);
        if (candidate.combination.residual <= largest) {
          found.push_back(candidate);
        }
      });
    });
  }
  return found;
}

std::vector<Candidate> findSums(const FlatDirections& flat, const std::vector<ParameterSpec>& parameters,
                                double largest) {
  constexpr Index kTerms = 2;
  const TermGradients gradients = calcTermGradients(flat, parameters);
  std::vector<Candidate> found;
  visitSubsets(static_cast<Index>(gradients.terms.size()), kTerms, [&](const std::vector<Index>& chosen) {
    Candidate candidate{fitSum(gradients, chosen), 0.0};
    if (candidate.combination.residual <= largest) {
      roundCoefficients(candidate.combination, flat, parameters);
      candidate.complexity = calcSumComplexity(candidate.combination, parameters);
      found.push_back(candidate);
    }
  });
  return found;
}

std::vector<Candidate> findBaseParameters(const FlatDirections& flat,
                                          const std::vector<ParameterSpec>& parameters, double largest) {
  constexpr std::size_t kMostTerms = 3;  // longer ones fit any smooth function: they name nothing
  const TermGradients gradients = calcTermGradients(flat, parameters);
  std::vector<Index> independent;
  std::vector<Candidate> found;
  for (Index k = 0; k < static_cast<Index>(gradients.terms.size()); ++k) {
    const VectorXd weights = solveFor(gradients.flat, independent, k);
    double rest = gradients.flat(k, k);
    Combination sum;
    for (std::size_t j = 0; j < independent.size(); ++j) {
      const double weight = weights[static_cast<Index>(j)];
      rest -= weight * gradients.flat(independent[j], k);
      if (std::abs(weight) > kExact) {
        sum.terms.push_back(gradients.terms[static_cast<std::size_t>(independent[j])]);
        sum.coefficients.push_back(-weight / gradients.scale[independent[j]]);
      }
    }
    if (rest > largest * largest) {
      independent.push_back(k);
      continue;
    }
    sum.terms.push_back(gradients.terms[static_cast<std::size_t>(k)]);
    sum.coefficients.push_back(1.0 / gradients.scale[k]);
    if (sum.terms.size() > kMostTerms) {
      continue;
    }
    divideByFirst(sum);
    roundCoefficients(sum, flat, parameters);
    if (sum.residual <= largest) {
      found.push_back({sum, calcSumComplexity(sum, parameters)});
    }
  }
  return found;
}

}  // namespace twinmap
