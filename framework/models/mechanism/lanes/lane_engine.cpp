#include "framework/models/mechanism/lanes/lane_engine.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

void LaneEngine::simulate(const Eigen::Ref<const MatrixXd>& parameters, Eigen::Ref<MatrixXd> responses,
                          SampleStatus* statuses) {
  if (!runner_) {
    runner_.emplace(programs_.getValues(), task_, context_.model);
  }
  for (const Index i : keepRetried(runner_->run(checks_, parameters, responses, nullptr, statuses))) {
    updStiffRetry().simulate(parameters.col(i), responses.col(i), statuses[i]);
  }
}

void LaneEngine::simulateWithDerivatives(const Eigen::Ref<const MatrixXd>& parameters,
                                         Eigen::Ref<MatrixXd> responses, MatrixXd& derivatives,
                                         SampleStatus* statuses) {
  if (!derivative_runner_) {
    derivative_runner_.emplace(programs_.getDerivatives(context_.names), task_, context_.model);
  }
  const Index p = parameters.rows();
  for (const Index i :
       keepRetried(derivative_runner_->run(checks_, parameters, responses, &derivatives, statuses))) {
    updStiffRetry().simulateWithDerivatives(parameters.col(i), responses.col(i),
                                            derivatives.middleCols(i * p, p), statuses[i]);
  }
}

/// None where there are events, which the implicit method does not look for, or too many coordinates.
std::vector<Index> LaneEngine::keepRetried(std::vector<Index> columns) const {
  const LaneModel& model = programs_.getValues();
  return model.hasEvents() || !model.isDifferentiated() ? std::vector<Index>{} : std::move(columns);
}

StiffRetry& LaneEngine::updStiffRetry() {
  if (!stiff_retry_) {
    stiff_retry_.emplace(context_.model, programs_.getValues(), programs_.getStiff(context_.names), task_);
  }
  return *stiff_retry_;
}

}  // namespace twinmap
