#include "framework/estimation/ridges/identified_combinations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "framework/base/random/random.hpp"
#include "framework/estimation/ridges/candidates.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ParameterSpec makeParameter(const std::string& name, const std::string& unit, double lower, double upper) {
  ParameterSpec parameter;
  parameter.name.text = name;
  parameter.unit = unit;
  parameter.bounds = {lower, upper, {}};
  return parameter;
}

/// What is determined of the parameters, as functions of a point.
using Determined = std::function<VectorXd(const VectorXd&)>;

/// The information about the parameters at 40 points of the box where functions of them are measured to 1e-3
/// of what they change over it, by exact derivatives (complex steps would do no better than central
/// differences of polynomials here). place: where a point is put.
std::vector<Ridge> findIn(
    const std::vector<ParameterSpec>& parameters, const Determined& determined,
    const Determined& place = [](const VectorXd& point) { return point; },
    RidgePoints of = RidgePoints::kOfAny) {
  constexpr Index kPoints = 40;
  constexpr double kStep = 1e-5;
  const VectorXd widths = calcWidths(parameters), lower = calcLowerBounds(parameters);
  const RandomStream random(3, RandomPurpose::kTestDesign);
  MatrixXd points(widths.size(), kPoints);
  std::vector<MatrixXd> information;
  for (Index i = 0; i < kPoints; ++i) {
    for (Index j = 0; j < widths.size(); ++j) {
      points(j, i) = lower[j] + widths[j] * random.calcUniform(static_cast<std::uint64_t>(i),
                                                               static_cast<std::uint64_t>(j));
    }
    points.col(i) = place(points.col(i));
    const VectorXd value = determined(points.col(i));
    MatrixXd jacobian(value.size(), widths.size());
    for (Index j = 0; j < widths.size(); ++j) {
      VectorXd step = VectorXd::Zero(widths.size());
      step[j] = kStep * widths[j];
      jacobian.col(j) = (determined(points.col(i) + step) - determined(points.col(i) - step)) / (2.0 * kStep);
    }
    jacobian = (1e3 * value.cwiseAbs().cwiseInverse()).asDiagonal() * jacobian;
    information.push_back(jacobian.transpose() * jacobian);
  }
  return findRidges(information, points, parameters, of);
}

std::vector<std::string> listExpressions(const std::vector<Ridge>& ridges,
                                         const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> expressions;
  for (const DerivedEntry& entry : listDerived(ridges, parameters)) {
    expressions.push_back(entry.expression);
  }
  return expressions;
}

using Names = std::vector<std::string>;

TEST(IdentifiedCombinations, NameAProduct) {
  const std::vector<ParameterSpec> parameters{makeParameter("m", "kg", 0.4, 0.8),
                                              makeParameter("L", "m", 0.3, 0.6),
                                              makeParameter("J", "kg m2", 0.1, 0.25)};
  const auto ridges =
      findIn(parameters, [](const VectorXd& x) { return Eigen::Vector2d(x[0] * x[1], x[2]).eval(); });
  ASSERT_EQ(ridges.size(), 1U);
  EXPECT_EQ(ridges[0].parameters, (std::vector<Index>{0, 1}));
  EXPECT_EQ(ridges[0].dimension, 1);
  EXPECT_LT(ridges[0].combinations[0].residual, 1e-6);
  EXPECT_EQ(describeRidge(ridges[0], parameters), "of m, L the features determine only m * L");
  EXPECT_EQ(makeDerivedYaml(ridges, parameters), "derived:\n  m_L: {value: m * L, unit: kg m}\n");
}

/// k / m is that of the file upside down; c / m is not there.
TEST(IdentifiedCombinations, AreNotAdvisedWhereTheFileDerivesThem) {
  ExperimentSpec experiment;
  experiment.model.parameters = {makeParameter("k", "N/m", 5, 15), makeParameter("m", "kg", 1, 2),
                                 makeParameter("c", "N s/m", 0.1, 0.4)};
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  const std::vector<Ridge> ridges =
      findIn(parameters, [](const VectorXd& x) { return Eigen::Vector2d(x[0] / x[1], x[2] / x[1]).eval(); });
  EXPECT_NE(adviseOnRidges(ridges, parameters)[0].find("{value: k / m, unit: 1/s2}"), std::string::npos);
  DerivedSpec inverse;
  inverse.name.text = "m_per_k";
  inverse.value.text = "m / k";
  experiment.derived = {inverse};
  const DerivedQuantities derived(experiment);
  const std::string advice = adviseOnRidges(ridges, parameters, &derived, Eigen::Vector3d(8.0, 1.5, 0.2))[0];
  EXPECT_EQ(
      advice,
      "of k, m, c the features determine only k / m, k / c; reported with 'derived: {k_per_c: {value: k / c, "
      "unit: 1/s}}'");
}

TEST(IdentifiedCombinations, NameAQuotient) {
  const std::vector<ParameterSpec> parameters{makeParameter("k", "N/m", 5, 15),
                                              makeParameter("m", "kg", 1, 2)};
  const auto ridges = findIn(
      parameters, [](const VectorXd& x) { return VectorXd::Constant(1, std::sqrt(x[0] / x[1])).eval(); });
  EXPECT_EQ(makeDerivedYaml(ridges, parameters), "derived:\n  k_per_m: {value: k / m, unit: 1/s2}\n");
}

TEST(IdentifiedCombinations, NameTwoQuotientsOfThree) {
  const std::vector<ParameterSpec> parameters{makeParameter("k", "", 5, 15), makeParameter("m", "", 1, 2),
                                              makeParameter("c", "", 0.1, 0.4)};
  const auto ridges =
      findIn(parameters, [](const VectorXd& x) { return Eigen::Vector2d(x[0] / x[1], x[2] / x[1]).eval(); });
  EXPECT_EQ(listExpressions(ridges, parameters), (Names{"k / m", "k / c"}));
}

/// Of a free motion, with damping that may be none: it cannot divide, so that d / m is upside down.
TEST(IdentifiedCombinations, NameAQuotientOfWhatMayBeNone) {
  const std::vector<ParameterSpec> parameters{makeParameter("m", "", 1, 2), makeParameter("k", "", 5, 15),
                                              makeParameter("d", "", 0, 3)};
  const auto ridges =
      findIn(parameters, [](const VectorXd& x) { return Eigen::Vector2d(x[1] / x[0], x[2] / x[0]).eval(); });
  EXPECT_EQ(listExpressions(ridges, parameters), (Names{"m / k", "d / m"}));
}

TEST(IdentifiedCombinations, NameRatiosOfAChain) {
  const std::vector<ParameterSpec> parameters{
      makeParameter("m_1", "kg", 1, 2), makeParameter("m_2", "kg", 1, 3), makeParameter("m_3", "kg", 0.5, 2)};
  const auto ridges =
      findIn(parameters, [](const VectorXd& x) { return Eigen::Vector2d(x[0] / x[1], x[1] / x[2]).eval(); });
  EXPECT_EQ(listExpressions(ridges, parameters), (Names{"m_1 / m_2", "m_1 / m_3"}));
}

TEST(IdentifiedCombinations, NameASumInANarrowBoxToo) {
  for (const double half_width : {0.5, 0.05}) {
    const std::vector<ParameterSpec> parameters{
        makeParameter("c_1", "N s/m", 1 - half_width, 1 + half_width),
        makeParameter("c_2", "N s/m", 2 - half_width, 2 + half_width)};
    const auto ridges =
        findIn(parameters, [](const VectorXd& x) { return VectorXd::Constant(1, x[0] + x[1]).eval(); });
    EXPECT_EQ(makeDerivedYaml(ridges, parameters),
              "derived:\n  c_1_plus_c_2: {value: c_1 + c_2, unit: kg/s}\n");
  }
}

TEST(IdentifiedCombinations, FindTheCoefficientsOfASum) {
  const std::vector<ParameterSpec> parameters{makeParameter("k_1", "N/m", 5, 15),
                                              makeParameter("k_2", "N/m", -3, 15)};
  const auto ridges =
      findIn(parameters, [](const VectorXd& x) { return VectorXd::Constant(1, x[0] + 0.36 * x[1]).eval(); });
  EXPECT_EQ(listExpressions(ridges, parameters), Names{"k_1 + 0.36 * k_2"});
}

TEST(IdentifiedCombinations, NameAPowerAndADifference) {
  const std::vector<ParameterSpec> powers{makeParameter("a", "m", 1, 3), makeParameter("b", "m", 1, 2)};
  EXPECT_EQ(listExpressions(findIn(powers,
                                   [](const VectorXd& x) {
                                     return VectorXd::Constant(1, x[0] * std::pow(x[1], 3)).eval();
                                   }),
                            powers),
            Names{"a * b^3"});
  EXPECT_EQ(
      listExpressions(
          findIn(powers, [](const VectorXd& x) { return VectorXd::Constant(1, x[0] - 2 * x[1] - 9).eval(); }),
          powers),
      Names{"a - 2 * b"});
}

TEST(IdentifiedCombinations, NameBaseParametersOfAPendulum) {
  // J + m L^2 acts with every acceleration, m L with gravity; m, L and J alone with nothing
  const std::vector<ParameterSpec> parameters{makeParameter("m", "kg", 0.5, 1.5),
                                              makeParameter("L", "m", 0.3, 0.6),
                                              makeParameter("J", "kg m2", 0.1, 0.25)};
  const auto ridges = findIn(parameters, [](const VectorXd& x) {
    return Eigen::Vector2d(x[2] + x[0] * x[1] * x[1], x[0] * x[1]).eval();
  });
  EXPECT_EQ(makeDerivedYaml(ridges, parameters),
            "derived:\n  m_L: {value: m * L, unit: kg m}\n"
            "  J_plus_m_L2: {value: J + m * L^2, unit: kg m2}\n");
}

TEST(IdentifiedCombinations, HaveTermsOfOneUnitWhereAllPointsAreOfOneMeasurement) {
  // where m L is .45 everywhere, J + .45 L is as good, and simpler
  const std::vector<ParameterSpec> parameters{makeParameter("m", "kg", 0.5, 1.5),
                                              makeParameter("L", "m", 0.3, 0.6),
                                              makeParameter("J", "kg m2", 0.05, 0.3)};
  const Determined place = [](const VectorXd& x) -> VectorXd {
    return Eigen::Vector3d(0.45 / x[1], x[1], 0.3 - 0.45 * x[1]);
  };
  const auto determined = [](const VectorXd& x) {
    return Eigen::Vector2d(x[2] + x[0] * x[1] * x[1], x[0] * x[1]).eval();
  };
  EXPECT_EQ(listExpressions(findIn(parameters, determined, place), parameters),
            (Names{"m * L", "J + m * L^2"}));
}

TEST(IdentifiedCombinations, NameBaseParametersOfTwoLinks) {
  // first link of known length .5: J_1 + m_1 L_1^2 + m_2 / 4; second link: m_2 L_2 and J_2 + m_2 L_2^2
  const std::vector<ParameterSpec> parameters{
      makeParameter("J_1", "", 0.1, 0.3), makeParameter("m_1", "", 1, 2), makeParameter("m_2", "", 1, 3),
      makeParameter("J_2", "", 0.1, 0.3), makeParameter("L_2", "", 0.1, 0.4)};
  const auto ridges = findIn(parameters, [](const VectorXd& x) {
    return Eigen::Vector3d(x[0] + 0.09 * x[1] + 0.25 * x[2], x[2] * x[4], x[3] + x[2] * x[4] * x[4]).eval();
  });
  EXPECT_EQ(listExpressions(ridges, parameters),
            (Names{"m_2 * L_2", "J_2 + m_2 * L_2^2", "J_1 + 0.09 * m_1 + 0.25 * m_2"}));
}

/// Points that fit one measurement of an arm of two links, as far as its bounds reach: m_2 changes by a fifth
/// of its width along the ridge, and must not be taken for known. .4 m is the first link's length.
TEST(IdentifiedCombinations, LeaveOutNoParameterThatChangesLittle) {
  const std::vector<ParameterSpec> parameters{
      makeParameter("m_1", "kg", 0.6, 1.8),       makeParameter("c_1", "m", 0.1, 0.3),
      makeParameter("I_1", "kg m2", 0.005, 0.04), makeParameter("m_2", "kg", 0.4, 5),
      makeParameter("c_2", "m", 0.05, 0.3),       makeParameter("I_2", "kg m2", 0.002, 0.06)};
  const Determined base = [](const VectorXd& x) -> VectorXd {
    return Eigen::Vector4d(x[0] * x[1] + 0.4 * x[3], x[3] * x[4], x[2] + x[0] * x[1] * x[1] + 0.16 * x[3],
                           x[5] + x[3] * x[4] * x[4]);
  };
  const Determined place = [](const VectorXd& x) -> VectorXd {
    const double m_2 = (1.44 - x[0] * x[1]) / 0.4, c_2 = 0.54 / m_2;
    VectorXd placed(6);
    placed << x[0], x[1], 0.54 - x[0] * x[1] * x[1] - 0.16 * m_2, m_2, c_2, 0.127 - m_2 * c_2 * c_2;
    return placed;
  };
  const std::vector<Ridge> ridges = findIn(parameters, base, place, RidgePoints::kOfOneMeasurement);
  ASSERT_EQ(ridges.size(), 1U);
  EXPECT_EQ(ridges[0].dimension, 2);
  EXPECT_EQ(describeRidge(ridges[0], parameters),
            "of m_1, c_1, I_1, m_2, c_2, I_2 the features determine only m_2 * c_2, I_2 + m_2 * c_2^2, m_2 + "
            "2.5 * m_1 * c_1 (2.5 in 1/m), I_1 + 0.16 * m_2 + m_1 * c_1^2 (0.16 in m2)");
}

/// Two other ridges with a parameter that changes by some per cent of its width.
TEST(IdentifiedCombinations, LeaveOutNoParameterOfWideBounds) {
  const std::vector<ParameterSpec> parameters{makeParameter("a", "N", 1, 3),
                                              makeParameter("b", "N", 0.1, 20)};
  const Determined sum = [](const VectorXd& x) { return VectorXd::Constant(1, x[0] + 0.4 * x[1]).eval(); };
  const Determined on_sum = [](const VectorXd& x) -> VectorXd {
    return Eigen::Vector2d(x[0], (5.0 - x[0]) / 0.4);
  };
  EXPECT_EQ(listExpressions(findIn(parameters, sum, on_sum, RidgePoints::kOfOneMeasurement), parameters),
            Names{"a + 0.4 * b"});
  const Determined product = [](const VectorXd& x) { return VectorXd::Constant(1, x[0] * x[1]).eval(); };
  const Determined on_product = [](const VectorXd& x) -> VectorXd {
    return Eigen::Vector2d(x[0], 2.0 / x[0]);
  };
  EXPECT_EQ(
      listExpressions(findIn(parameters, product, on_product, RidgePoints::kOfOneMeasurement), parameters),
      Names{"a * b"});
}

/// exp(a) + sin(3 b) + 5 b: no simple function of a and b is constant along it.
TEST(IdentifiedCombinations, NameWhatHoldsNearTheBestFitAsSuch) {
  const std::vector<ParameterSpec> parameters{makeParameter("a", "N", 0.5, 3),
                                              makeParameter("b", "m", 0.5, 3)};
  const Determined odd = [](const VectorXd& x) {
    return VectorXd::Constant(1, std::exp(x[0]) + std::sin(3 * x[1]) + 5.0 * x[1]).eval();
  };
  const Determined place = [&](const VectorXd& x) -> VectorXd {
    return Eigen::Vector2d(std::log(25.0 - std::sin(3 * x[1]) - 5.0 * x[1]), x[1]);
  };
  const std::vector<Ridge> ridges = findIn(parameters, odd, place, RidgePoints::kOfOneMeasurement);
  ASSERT_EQ(ridges.size(), 1U);
  EXPECT_TRUE(ridges[0].combinations.empty());
  ASSERT_EQ(ridges[0].local.size(), 1U);
  EXPECT_EQ(makeDerivedYaml(ridges, parameters), "");
  EXPECT_NE(describeRidge(ridges[0], parameters)
                .find("no simple combination of them holds wherever they fit: "
                      "near the best fit only a + "),
            std::string::npos)
      << describeRidge(ridges[0], parameters);
}

TEST(IdentifiedCombinations, AreConstantWhereAllPointsFit) {
  const std::vector<ParameterSpec> parameters{makeParameter("a", "", 1, 3), makeParameter("b", "", 1, 3)};
  constexpr Index kPoints = 9;
  FlatDirections flat{{0, 1}, 1, {}, MatrixXd(2, kPoints), {}};
  for (Index i = 0; i < kPoints; ++i) {  // along a b = 3
    const double a = 1.0 + 0.25 * static_cast<double>(i);
    flat.points.col(i) << a, 3.0 / a;
    flat.changes.emplace_back(Eigen::Vector2d(a, -3.0 / a).normalized());
    flat.determined.emplace_back(MatrixXd::Zero(2, 2));
  }
  const Combination product{{Eigen::Vector2i(1, 1)}, {1.0}, 0.0};
  const Combination sum{{Eigen::Vector2i(1, 0), Eigen::Vector2i(0, 1)}, {1.0, 1.0}, 0.0};
  EXPECT_TRUE(isConstant(product, flat, parameters));
  EXPECT_FALSE(isConstant(sum, flat, parameters));
  flat.determined.assign(kPoints, MatrixXd::Identity(2, 2));  // nothing is known of either
  EXPECT_TRUE(isConstant(sum, flat, parameters));
}

TEST(FlatDirections, AreNotWhereAPosteriorIsNarrow) {
  // along (1, -1) a share of the uniform distribution's standard deviation, across it nothing
  const auto spread = [](double share) -> MatrixXd {
    const Eigen::Vector2d along(std::sqrt(0.5), -std::sqrt(0.5));
    return share * share / 12.0 * along * along.transpose();
  };
  EXPECT_TRUE(mayBeFlat(spread(1.0)));
  EXPECT_TRUE(mayBeFlat(spread(0.3)));
  EXPECT_FALSE(mayBeFlat(spread(0.2)));
}

TEST(IdentifiedCombinations, SeparateRidgesThatHaveNothingInCommon) {
  const std::vector<ParameterSpec> parameters{makeParameter("a", "", 1, 3), makeParameter("b", "", 1, 2),
                                              makeParameter("c", "", 1, 3), makeParameter("d", "", 1, 2)};
  const auto ridges =
      findIn(parameters, [](const VectorXd& x) { return Eigen::Vector2d(x[0] * x[2], x[1] + x[3]).eval(); });
  EXPECT_EQ(ridges.size(), 2U);
  EXPECT_EQ(listExpressions(ridges, parameters), (Names{"a * c", "b + d"}));
}

TEST(IdentifiedCombinations, SayNothingWhereAllIsDeterminedOrAParameterAloneIsNot) {
  const std::vector<ParameterSpec> parameters{makeParameter("a", "", 1, 3), makeParameter("b", "", 1, 2)};
  EXPECT_TRUE(findIn(parameters, [](const VectorXd& x) { return x; }).empty());
  EXPECT_TRUE(
      findIn(parameters, [](const VectorXd& x) { return VectorXd::Constant(1, x[0]).eval(); }).empty());
}

TEST(IdentifiedCombinations, HaveAtMostThreeTerms) {
  const std::vector<ParameterSpec> parameters{makeParameter("a", "", 0.5, 3), makeParameter("b", "", 0.5, 3)};
  const auto ridges = findIn(parameters, [](const VectorXd& x) {
    return VectorXd::Constant(1, x[0] + x[1] + 0.3 * x[0] * x[0] + x[0] * x[1] - 0.2 * x[1] * x[1]).eval();
  });
  ASSERT_EQ(ridges.size(), 1U);
  for (const Combination& combination : ridges[0].combinations) {
    EXPECT_LE(combination.terms.size(), 3U);
  }
}

TEST(IdentifiedCombinations, AdmitWhereNothingSimpleFits) {
  const std::vector<ParameterSpec> parameters{makeParameter("a", "", 0.5, 3), makeParameter("b", "", 0.5, 3)};
  const auto ridges = findIn(parameters, [](const VectorXd& x) {
    return VectorXd::Constant(1, std::exp(x[0]) + std::sin(3 * x[1])).eval();
  });
  ASSERT_EQ(ridges.size(), 1U);
  EXPECT_TRUE(ridges[0].combinations.empty());
  EXPECT_EQ(makeDerivedYaml(ridges, parameters), "");
}

}  // namespace
}  // namespace twinmap
