#include "framework/estimation/ridges/combination.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/units.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;
using Eigen::VectorXi;

namespace {

std::string makePower(const std::string& name, int exponent) {
  return exponent == 1 ? name : name + "^" + std::to_string(exponent);
}

/// The factors with exponents of one sign, the other's left out: "m * L^2".
std::string joinFactors(const VectorXi& exponents, const std::vector<ParameterSpec>& parameters, int sign) {
  std::string text;
  for (Index j = 0; j < exponents.size(); ++j) {
    if (sign * exponents[j] > 0) {
      text += (text.empty() ? "" : " * ") +
              makePower(parameters[static_cast<std::size_t>(j)].name.text, std::abs(exponents[j]));
    }
  }
  return text;
}

std::string makeProduct(const VectorXi& exponents, const std::vector<ParameterSpec>& parameters) {
  const std::string above = joinFactors(exponents, parameters, 1);
  const std::string below = joinFactors(exponents, parameters, -1);
  const bool several = (exponents.array() < 0).count() > 1;
  return (above.empty() ? "1" : above) + (below.empty() ? ""
                                          : several     ? " / (" + below + ")"
                                                        : " / " + below);
}

std::string makeNamePart(const VectorXi& exponents, const std::vector<ParameterSpec>& parameters) {
  std::string above, below;
  for (Index j = 0; j < exponents.size(); ++j) {
    const int power = std::abs(exponents[j]);
    const std::string part =
        parameters[static_cast<std::size_t>(j)].name.text + (power > 1 ? std::to_string(power) : "");
    std::string& side = exponents[j] > 0 ? above : below;
    side += exponents[j] == 0 ? "" : (side.empty() ? "" : "_") + part;
  }
  return (above.empty() ? "one" : above) + (below.empty() ? "" : "_per_" + below);
}

/// The dimension of a product; false where a unit is not stated.
bool addDimension(const VectorXi& exponents, const std::vector<ParameterSpec>& parameters,
                  Dimension& dimension) {
  for (Index j = 0; j < exponents.size(); ++j) {
    const ParameterSpec& parameter = parameters[static_cast<std::size_t>(j)];
    if (exponents[j] == 0) {
      continue;
    }
    if (parameter.unit.empty()) {
      return false;
    }
    for (const auto& [base, power] : parseUnit(parameter.unit, parameter.name.where)) {
      dimension[base] += exponents[j] * power;
    }
  }
  return true;
}

std::string makeUnit(const Dimension& dimension) {
  std::string above, below;
  for (const auto& [base, power] : dimension) {
    const double size = std::abs(power);
    const bool is_whole = size == std::floor(size);  // "m2", but "m^1.5"
    const std::string text = base + (size == 1.0 ? "" : (is_whole ? "" : "^") + toText(size));
    if (power > 0) {
      above += (above.empty() ? "" : " ") + text;
    } else if (power < 0) {
      below += "/" + text;
    }
  }
  return above.empty() && !below.empty() ? "1" + below : above + below;
}

Dimension dropZeros(const Dimension& dimension) {
  Dimension kept;
  for (const auto& [base, power] : dimension) {
    if (power != 0) {
      kept[base] = power;
    }
  }
  return kept;
}

/// Of each term; false where a parameter states no unit.
bool listDimensions(const Combination& combination, const std::vector<ParameterSpec>& parameters,
                    std::vector<Dimension>& dimensions) {
  for (const VectorXi& term : combination.terms) {
    Dimension dimension;
    if (!addDimension(term, parameters, dimension)) {
      return false;
    }
    dimensions.push_back(dropZeros(dimension));
  }
  return true;
}

}  // namespace

double calcProduct(const VectorXi& exponents, const VectorXd& point) {
  double value = 1.0;
  for (Index j = 0; j < exponents.size(); ++j) {
    value *= exponents[j] == 0 ? 1.0 : std::pow(point[j], exponents[j]);
  }
  return value;
}

VectorXd calcProductGradient(const VectorXi& exponents, const VectorXd& point) {
  VectorXd gradient = VectorXd::Zero(point.size());
  for (Index j = 0; j < point.size(); ++j) {
    if (exponents[j] != 0) {
      VectorXi lowered = exponents;
      --lowered[j];
      gradient[j] = exponents[j] * calcProduct(lowered, point);
    }
  }
  return gradient;
}

void divideByFirst(Combination& sum) {
  const double first = sum.coefficients.front();
  for (double& coefficient : sum.coefficients) {
    coefficient /= first;
  }
}

double roundToThreeDigits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  return unit * std::round(value / unit);
}

double calcValue(const Combination& combination, const VectorXd& point) {
  double value = 0.0;
  for (std::size_t k = 0; k < combination.terms.size(); ++k) {
    value += combination.coefficients[k] * calcProduct(combination.terms[k], point);
  }
  return value;
}

VectorXd calcGradient(const Combination& combination, const VectorXd& point) {
  VectorXd gradient = VectorXd::Zero(point.size());
  for (std::size_t k = 0; k < combination.terms.size(); ++k) {
    gradient += combination.coefficients[k] * calcProductGradient(combination.terms[k], point);
  }
  return gradient;
}

std::string makeExpression(const Combination& combination, const std::vector<ParameterSpec>& parameters) {
  std::string text;
  for (std::size_t k = 0; k < combination.terms.size(); ++k) {
    const double coefficient = combination.coefficients[k], size = std::abs(coefficient);
    text += coefficient < 0.0 ? (k == 0 ? "-" : " - ") : (k == 0 ? "" : " + ");
    text += (size == 1.0 ? "" : toShortText(size, kEstimateDigits) + " * ") +
            makeProduct(combination.terms[k], parameters);
  }
  return text;
}

std::string makeName(const Combination& combination, const std::vector<ParameterSpec>& parameters) {
  std::string name;
  for (std::size_t k = 0; k < combination.terms.size(); ++k) {
    name += (k == 0                              ? ""
             : combination.coefficients[k] < 0.0 ? "_minus_"
                                                 : "_plus_") +
            makeNamePart(combination.terms[k], parameters);
  }
  return name;
}

bool hasOneUnit(const Combination& combination, const std::vector<ParameterSpec>& parameters) {
  std::vector<Dimension> dimensions;
  return !listDimensions(combination, parameters, dimensions) ||
         std::all_of(dimensions.begin(), dimensions.end(),
                     [&](const Dimension& one) { return one == dimensions.front(); });
}

std::string findUnit(const Combination& combination, const std::vector<ParameterSpec>& parameters) {
  std::vector<Dimension> dimensions;
  return listDimensions(combination, parameters, dimensions) ? makeUnit(dimensions.front()) : "";
}

std::string describeConstants(const Combination& combination, const std::vector<ParameterSpec>& parameters) {
  std::vector<Dimension> dimensions;
  std::string text;
  if (listDimensions(combination, parameters, dimensions)) {
    for (std::size_t k = 1; k < dimensions.size(); ++k) {
      Dimension constant = dimensions.front();
      for (const auto& [base, power] : dimensions[k]) {
        constant[base] -= power;
      }
      const std::string unit = makeUnit(dropZeros(constant));
      if (!unit.empty()) {
        text += (text.empty() ? "" : ", ") +
                toShortText(std::abs(combination.coefficients[k]), kEstimateDigits) + " in " + unit;
      }
    }
  }
  return text;
}

}  // namespace twinmap
