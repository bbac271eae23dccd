#pragma once

#include <cmath>
#include <functional>

#include "framework/base/random/random.hpp"
#include "framework/estimation/refined/refine.hpp"
#include "tests/framework/support/linear_simulator.hpp"

namespace twinmap::testing {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Response = std::function<VectorXd(const VectorXd&)>;

/// A response at the times 1, 2, ... that is a function of the point; NaN where it fails.
class FunctionSimulator final : public Simulator {
 public:
  FunctionSimulator(int times, Response response) : response_(std::move(response)) {
    layout_ = {{"y"}, {"m"}, VectorXd::LinSpaced(times, 1.0, times)};
  }
  const ResponseLayout& getLayout() const override { return layout_; }
  void simulate(const Eigen::Ref<const MatrixXd>& parameters, Eigen::Ref<MatrixXd> responses,
                SampleStatus* statuses) override {
    for (Index i = 0; i < parameters.cols(); ++i) {
      responses.col(i) = response_(parameters.col(i));
      statuses[i] = responses.col(i).allFinite() ? SampleStatus{} : SampleStatus{false, "cannot be"};
    }
  }
  std::unique_ptr<Simulator> clone() const override { return std::make_unique<FunctionSimulator>(*this); }

 private:
  Response response_;
  ResponseLayout layout_;
};

/// All samples of a simulator as features, with noise.
struct Problem {
  Problem(int times, Response response, std::vector<ParameterSpec> unknown, double noise_stddev)
      : simulator(times, std::move(response)),
        extractor({SamplesFeatureSpec{{{"y", {}}}, 1.0, 1.0, times}}, simulator.getLayout()),
        noise(extractor, ResponseNoise(VectorXd::Constant(times, noise_stddev)), 1),
        model(std::move(unknown), extractor, noise) {}

  VectorXd measure(const VectorXd& point, double noise_stddev, std::uint64_t seed = 1) {
    MatrixXd response(simulator.getLayout().getRowCount(), 1);
    SampleStatus status;
    simulator.simulate(point, response, &status);
    return addNoise(response, ResponseNoise(VectorXd::Constant(response.rows(), noise_stddev)),
                    {seed, RandomPurpose::kTestNoise})
        .col(0);
  }

  Refined refineFrom(const VectorXd& features, const std::vector<RefinementStart>& starts,
                     bool uses_growing_windows = false) {
    return refine(simulator, model,
                  {features, starts, {0, starts.front().point.size()}, uses_growing_windows});
  }

  FunctionSimulator simulator;
  FeatureExtractor extractor;
  FeatureNoise noise;
  RefinementModel model;
};

inline VectorXd makeVector(std::initializer_list<double> values) {
  return Eigen::Map<const VectorXd>(values.begin(), static_cast<Index>(values.size()));
}

/// Entries of a matrix without structure.
inline MatrixXd makeMatrix(Index rows, Index columns) {
  return MatrixXd::NullaryExpr(rows, columns, [](Index i, Index j) {
    return std::sin(1.0 + 3.7 * static_cast<double>(i) + 1.3 * static_cast<double>(j * j));
  });
}

}  // namespace twinmap::testing
