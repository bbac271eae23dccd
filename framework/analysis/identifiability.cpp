#include "framework/analysis/identifiability.hpp"

#include <cmath>
#include <cstdio>

#include "framework/base/log/notice.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kUndetermined = 0.5;  // of the box's own standard deviation

MatrixXd fixSigns(MatrixXd vectors) {
  for (Index k = 0; k < vectors.cols(); ++k) {
    Index largest = 0;
    vectors.col(k).cwiseAbs().maxCoeff(&largest);
    vectors.col(k) *= vectors(largest, k) < 0.0 ? -1.0 : 1.0;
  }
  return vectors;
}

std::string toPercent(double fraction) {
  char text[16];
  std::snprintf(text, sizeof(text), "%.0f %%", 100.0 * fraction);
  return text;
}

/// "'k_1' (correlation 0.98), 'm_2' (-0.71)"
std::string listPartners(const MatrixXd& correlation, Index parameter,
                         const std::vector<ParameterSpec>& parameters) {
  constexpr double kPartner = 0.5;
  std::string list;
  for (Index j = 0; j < correlation.cols(); ++j) {
    if (j != parameter && std::abs(correlation(parameter, j)) > kPartner) {
      char text[32];
      std::snprintf(text, sizeof(text), " (%s%.2f)", list.empty() ? "correlation " : "",
                    correlation(parameter, j));
      list += (list.empty() ? "'" : ", '") + parameters[j].name.text + "'" + text;
    }
  }
  return list;
}

std::string explain(Index parameter, double remaining, const InformationLimit& limit,
                    const std::vector<ParameterSpec>& parameters) {
  const std::string& name = parameters[parameter].name.text;
  const std::string reduction = toPercent(1.0 - remaining);
  const double alone =
      std::sqrt(kUniformInformation / (limit.mean_information(parameter, parameter) + kUniformInformation));
  if (alone > kUndetermined) {
    return describeNotice(Notice::kNotDetermined, name, toPercent(1.0 - alone));
  }
  const std::string partners = listPartners(calcCorrelation(limit.mean_covariance), parameter, parameters);
  return describeNotice(Notice::kConfounded, name, reduction,
                        partners.empty() ? "several others together" : partners);
}

}  // namespace

Identifiability calcIdentifiability(const InformationLimit& limit,
                                    const std::vector<ParameterSpec>& parameters) {
  Identifiability result;
  result.correlation = calcCorrelation(calcLimitCovariance(limit.mean_information));
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(limit.mean_information);
  result.eigenvalues = eigen.values;
  result.eigenvectors = fixSigns(eigen.vectors);
  result.remaining = limit.mean_covariance.diagonal().cwiseSqrt() / kUniformStddev;
  for (Index j = 0; j < result.remaining.size(); ++j) {
    if (result.isUndetermined(j)) {
      result.warnings.push_back(explain(j, result.remaining[j], limit, parameters));
    }
  }
  return result;
}

}  // namespace twinmap
