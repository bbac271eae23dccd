#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap {

/// A sum of products of powers of parameters: m L, k / m, k_1 + k_2, J + m L^2.
struct Combination {
  /// Of each term: the integer exponents of all p parameters.
  std::vector<Eigen::VectorXi> terms;
  std::vector<double> coefficients;  ///< of each term; the first is 1
  /// Root mean square over the samples of the sine of the angle between its gradient and the directions that
  /// the data determine: 0 where it is one of the functions that are identified.
  double residual = 0.0;
};

/// The value of a product of powers at a point (p), and its gradient (p).
double calcProduct(const Eigen::VectorXi& exponents, const Eigen::VectorXd& point);
Eigen::VectorXd calcProductGradient(const Eigen::VectorXi& exponents, const Eigen::VectorXd& point);

/// Makes the first coefficient 1.
void divideByFirst(Combination& sum);
double roundToThreeDigits(double value);

/// The value of a combination at a point (p), and its gradient (p).
double calcValue(const Combination& combination, const Eigen::VectorXd& point);
Eigen::VectorXd calcGradient(const Combination& combination, const Eigen::VectorXd& point);

/// As an expression of the experiment file: "m * L", "k / m", "k_1 + 0.36 * k_2".
std::string makeExpression(const Combination& combination, const std::vector<ParameterSpec>& parameters);

/// A name for it: "m_L", "k_per_m", "k_1_plus_k_2".
std::string makeName(const Combination& combination, const std::vector<ParameterSpec>& parameters);

/// Whether its terms have one unit, or a parameter states none.
bool hasOneUnit(const Combination& combination, const std::vector<ParameterSpec>& parameters);

/// The unit of its first term, whose constant is 1, in SI base units: "kg m", "1/s2". "" where a parameter
/// states none, or it has none.
std::string findUnit(const Combination& combination, const std::vector<ParameterSpec>& parameters);

/// The units of constants in terms of other units, else "". It is "0.4 in m" of m * c + 0.4 * M with masses m
/// and M.
std::string describeConstants(const Combination& combination, const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
