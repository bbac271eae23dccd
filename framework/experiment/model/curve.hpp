#pragma once

#include <vector>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/curve_spec.hpp"

namespace twinmap {

/// The operations of a curve y(x) through values v_0 .. v_n at equal distances h over its range. Piecewise
/// cubic with the slopes s at the knots (for each h), d_i = v_i+1 - v_i:
/// - monotone: s_i = 2 d_i-1 d_i / (d_i-1 + d_i), 0 where the signs of the two differ (Fritsch and Butland,
///   SIAM J. Scientific and Statistical Computing 5, 1984, p. 300): between two knots the curve stays between
///   their values. Its first derivative is continuous. Where values rise, or fall, from knot to knot, it is a
///   smooth function of them;
/// - otherwise s_i-1 + 4 s_i + s_i+1 = 3 (v_i+1 - v_i-1), the spline with continuous second derivative,
///   which is linear in the values.
/// At both ends the last piece is a parabola (s_0 = 2 d_0 - s_1, which is monotone where the curve is);
/// beyond it is a straight line. Derivatives with respect to the argument and to the values are exact. Cost:
/// some 12 operations a knot, of which 5 depend on the argument.
class CurveExpansion {
 public:
  using Nodes = std::vector<ExpressionTree::Node>;

  /// `values`: bound to the names of what will be evaluated.
  CurveExpansion(const CurveSpec& spec, std::vector<BoundExpression> values)
      : range_(spec.range), monotone_(spec.monotone), values_(std::move(values)) {}

  /// Appends what it takes to `nodes`; `argument`: its place there. Returns the place of the value.
  int append(Nodes& nodes, int argument) const;

 private:
  Bounds range_;
  bool monotone_;
  std::vector<BoundExpression> values_;
};

/// Lets expressions that are bound to `names` call the curves. Throws as bind() does.
template <class S>
void defineCurves(const std::vector<CurveSpec>& curves, NamedValues<S>& names) {
  for (const CurveSpec& curve : curves) {
    std::vector<BoundExpression> values;
    for (const Expression& value : curve.values) {
      values.push_back(names.bind(value));
    }
    names.defineFunction(curve.name.text,
                         [expansion = CurveExpansion(curve, std::move(values))](auto& nodes, int argument) {
                           return expansion.append(nodes, argument);
                         });
  }
}

/// The parameters that are the values of a curve given by its number of knots: <name>_1 and on.
std::vector<Expression> listKnotParameters(const CurveSpec& curve);

}  // namespace twinmap
