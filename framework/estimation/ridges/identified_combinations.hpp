#pragma once

#include <string>
#include <vector>

#include "framework/estimation/derived/derived_quantities.hpp"
#include "framework/estimation/ridges/base_parameters.hpp"
#include "framework/estimation/ridges/combination.hpp"
#include "framework/estimation/ridges/flat_directions.hpp"

namespace twinmap {

/// Parameters of which the features determine combinations alone.
struct Ridge {
  std::vector<Eigen::Index> parameters;  ///< g, ascending
  Eigen::Index dimension = 0;            ///< r: so many of them, or combinations, are not determined
  /// The simplest independent functions of them that are determined; at most g - r, fewer where no simple
  /// ones fit.
  std::vector<Combination> combinations;
  /// Sums of the parameters that are determined near the best fit alone, in the place of those that are
  /// lacking.
  std::vector<Combination> local{};
  BaseParameters base{};  ///< of many parameters, in the place of combinations
};

/// Whether points all fit one measurement, the first one best, or are of any.
enum class RidgePoints { kOfAny, kOfOneMeasurement };

/// Names what is identified. A function is identified if its gradient is orthogonal to the flat directions
/// at all points. Sought are, from the simplest on,
/// - products of powers (exponents from -4 to 4 of two parameters, -3 to 3 of three, -2 to 2 of four),
/// - sums of two, then of three products of powers of degree 1 to 3 in one or two parameters, whose
///   coefficients follow from least squares; simple ones are taken where they fit. Base parameters of trees
///   (J + m L^2) are among these.
/// Those are taken that fit within .001 (Combination::residual), else .01, else .05: where the flat direction
/// is exact the first tells a product from a sum even in a narrow box. Of one measurement those of the other
/// two are constant (isConstant), or not taken. Cost: some 10 ms for six parameters.
std::vector<Ridge> nameRidges(const std::vector<FlatDirections>& flat,
                              const std::vector<ParameterSpec>& parameters,
                              RidgePoints of = RidgePoints::kOfAny);

/// The same from the Fisher information at points (findFlatDirections()), of which at most kStandingDraws are
/// looked at.
std::vector<Ridge> findRidges(const std::vector<Eigen::MatrixXd>& information, const Eigen::MatrixXd& points,
                              const std::vector<ParameterSpec>& parameters,
                              RidgePoints of = RidgePoints::kOfAny);

/// Of more than 16 parameters products and sums are not sought: base parameters are named (findStandardSums),
/// of the first point. No ridge where all are determined.
std::vector<Ridge> findRidges(const std::vector<Eigen::MatrixXd>& information, const Eigen::MatrixXd& points,
                              const ModelSpec& model, RidgePoints of);

/// Whether base parameters are named.
bool hasManyForNames(const ModelSpec& model);

/// "m, L".
std::string listParameters(const Ridge& ridge, const std::vector<ParameterSpec>& parameters);

/// "of m, L the features determine only m * L"; without combinations that they do not determine them one by
/// one. With the units of constants, and with sums that hold near the best fit alone, as such.
std::string describeRidge(const Ridge& ridge, const std::vector<ParameterSpec>& parameters);

/// A sentence for each ridge that has combinations, with what to add to the experiment file. What that
/// derives already (`derived`; null: nothing) is left out, as its gradients at `point` tell.
std::vector<std::string> adviseOnRidges(const std::vector<Ridge>& ridges,
                                        const std::vector<ParameterSpec>& parameters,
                                        const DerivedQuantities* derived = nullptr,
                                        const Eigen::VectorXd& point = {});

/// A combination as an entry below the key `derived`.
struct DerivedEntry {
  std::string name, expression, unit;
  double residual = 0.0;
  std::vector<std::pair<std::string, double>> terms{};  ///< of a base parameter: standard ones, coefficients
};

/// Those of all ridges, with different names.
std::vector<DerivedEntry> listDerived(const std::vector<Ridge>& ridges,
                                      const std::vector<ParameterSpec>& parameters);

/// The combinations of all ridges as lines of the experiment file, below the key `derived`; "" if there are
/// none.
std::string makeDerivedYaml(const std::vector<Ridge>& ridges, const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
