#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "framework/estimation/derived/derived_quantities.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What responses of bodies are linear in, as the field has it: of each body mass, first moments and tensor
/// about the origin of its frame, as far as its own parameters move them; all other parameters as they are.
/// As many as parameters, and of independent gradients.
struct StandardTerms {
  std::vector<std::string> labels;       ///< "forearm.m", "forearm.mx", "forearm.Ixy", "elbow_damping"
  std::vector<std::string> expressions;  ///< of the experiment file
  std::vector<std::string> units;
  std::shared_ptr<const DerivedQuantities> quantities;  ///< their values
};

/// A sum of standard terms that a measurement determines: terms[k].first is the place of a standard term, the
/// first one's coefficient is 1.
struct BaseParameter {
  std::vector<std::pair<Eigen::Index, double>> terms;
};

/// Base parameters of many parameters, with the terms that they are sums of.
struct BaseParameters {
  StandardTerms standard;
  std::vector<BaseParameter> sums;  ///< the best determined first; but parameters that are so by themselves
  std::vector<Eigen::Index> parameters{};  ///< but those
  Eigen::Index undetermined = 0;           ///< terms

  /// At a point (p).
  Eigen::VectorXd calc(const Eigen::VectorXd& point) const;
  /// "forearm.Izz + 0.09 * upper_arm.m", in labels or in expressions.
  std::string describe(std::size_t sum) const;
  std::string makeExpression(std::size_t sum) const;
  const std::string& getUnit(std::size_t sum) const;
};

/// Whether a body has mass, centre or inertia that parameters give.
bool hasInertialParameters(const ModelSpec& model);

/// Base parameters as identification of robots finds them, by a rank-revealing factorisation of the regressor
/// (Gautier 1991): the responses' derivatives by standard terms, here of its Gram matrix with pivots.
/// information: of the parameters (p x p) at a point, per width of their bounds. They hold everywhere if
/// responses are linear in the terms, else near the point. Empty where each parameter is determined by
/// itself. Cost: some p^4 flops.
BaseParameters findStandardSums(const Eigen::MatrixXd& information, const Eigen::VectorXd& point,
                                const ModelSpec& model);

}  // namespace twinmap
