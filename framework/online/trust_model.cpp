#include "framework/online/trust_model.hpp"

#include <algorithm>
#include <cmath>

#include "framework/spec/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kFarAway = 1.5;  // times the reach of simulated measurements
constexpr double kBeyondBoundsStddevs = 1.0;
constexpr double kShareOfPrior = 0.9;  // of the box's standard deviation

bool liesBeyondBounds(const TrustModel& model, const Inference& inference) {
  const Index p = inference.mean.size();
  const Eigen::ArrayXd beyond = (inference.mean - model.center.head(p)).array().abs() -
                                model.half_width.head(p).array() -
                                kBeyondBoundsStddevs * inference.stddev.array();
  return beyond.maxCoeff() > 0.0;
}

bool isUninformative(const TrustModel& model, const Inference& inference) {
  const Eigen::ArrayXd prior = 2.0 * kUniformStddev * model.half_width.head(inference.mean.size()).array();
  return (inference.stddev.array() > kShareOfPrior * prior).any();
}

/// The inferred parameters, the middle of the nuisance parameters' box, the known inputs; normalised.
void makeStart(const TrustModel& model, const Eigen::Ref<const VectorXd>& known, const Inference& inference,
               VectorXd& start) {
  start = model.center;
  start.head(inference.mean.size()) = inference.mean;
  start.tail(known.size()) = known;
  start = (start - model.center).cwiseQuotient(model.half_width);
}

}  // namespace

const char* toString(TrustStatus status) {
  switch (status) {
    case TrustStatus::kModelMismatch:
      return "model_mismatch";
    case TrustStatus::kOutsideTraining:
      return "outside_training";
    case TrustStatus::kAtBounds:
      return "at_bounds";
    case TrustStatus::kUninformative:
      return "uninformative";
    case TrustStatus::kOk:
      break;
  }
  return "ok";
}

double ReferenceDistribution::calcPValue(double value) const {
  const double* end = sorted.data() + sorted.size();
  const auto above = static_cast<double>(end - std::lower_bound(sorted.data(), end, value));
  return (above + 1.0) / (static_cast<double>(sorted.size()) + 1.0);
}

double TrainingCloud::calcDistance(const Eigen::Ref<const VectorXd>& at, VectorXd& buffer) const {
  buffer = at.cwiseQuotient(scale);
  return std::sqrt((inputs.colwise() - buffer).colwise().squaredNorm().minCoeff()) / reach;
}

Trust judge(const TrustModel& model, const Eigen::Ref<const VectorXd>& features,
            const Eigen::Ref<const VectorXd>& known, const Inference& inference, TrustWorkspace& workspace) {
  makeStart(model, known, inference, workspace.start);
  const Explanation& explanation =
      explain(model.forward, features, workspace.start, model.unknown, workspace.explanation);
  Trust trust;
  trust.chi_square = explanation.chi_square;
  trust.residuals = explanation.residual.size();
  trust.burst = findBurst(explanation.residual, model.runs);
  trust.chi_square_p_value = model.chi_square.calcPValue(trust.chi_square);
  trust.burst_p_value = model.burst.calcPValue(trust.burst.score);
  trust.p_value = std::min(1.0, 2.0 * std::min(trust.chi_square_p_value, trust.burst_p_value));
  trust.distance = model.cloud.calcDistance(inference.inputs, workspace.distance);
  if (trust.p_value < model.level) {
    trust.statuses.push_back(TrustStatus::kModelMismatch);
  }
  if (trust.distance > kFarAway) {
    trust.statuses.push_back(TrustStatus::kOutsideTraining);
  }
  if (liesBeyondBounds(model, inference)) {
    trust.statuses.push_back(TrustStatus::kAtBounds);
  }
  if (isUninformative(model, inference)) {
    trust.statuses.push_back(TrustStatus::kUninformative);
  }
  if (trust.statuses.empty()) {
    trust.statuses.push_back(TrustStatus::kOk);
  }
  return trust;
}

}  // namespace twinmap
