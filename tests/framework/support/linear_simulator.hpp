#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap::testing {

/// A model whose response is matrix * parameters: all that is inferred from it is known in closed form. A
/// first parameter that is NaN or above `fails_above` makes it fail.
class LinearSimulator final : public Simulator {
 public:
  explicit LinearSimulator(Eigen::MatrixXd matrix, double fails_above = 1e300)
      : matrix_(std::move(matrix)), fails_above_(fails_above) {
    layout_ = {
        {"y"}, {"m"}, Eigen::VectorXd::LinSpaced(matrix_.rows(), 1.0, static_cast<double>(matrix_.rows()))};
  }

  const ResponseLayout& getLayout() const override { return layout_; }

  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override {
    responses = matrix_ * parameters;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      const bool ok = parameters(0, i) <= fails_above_;
      statuses[i] = ok ? SampleStatus{} : SampleStatus{false, "too much"};
      if (!ok) {
        responses.col(i).setConstant(std::nan(""));
      }
    }
  }

  std::unique_ptr<Simulator> clone() const override { return std::make_unique<LinearSimulator>(*this); }

 private:
  Eigen::MatrixXd matrix_;
  double fails_above_;
  ResponseLayout layout_;
};

/// Every row of a LinearSimulator's response as a feature.
inline std::vector<FeatureSpec> makeAllFeatures(const LinearSimulator& simulator) {
  return {SamplesFeatureSpec{{{"y", {}}}, 1.0, 1.0, static_cast<int>(simulator.getLayout().times.size())}};
}

/// Parameters "a", "b", ... within the same bounds.
inline std::vector<ParameterSpec> makeParameters(int count, double lower, double upper) {
  std::vector<ParameterSpec> parameters(count);
  for (int j = 0; j < count; ++j) {
    parameters[j].name.text = std::string(1, static_cast<char>('a' + j));
    parameters[j].bounds = {lower, upper, {}};
  }
  return parameters;
}

}  // namespace twinmap::testing
