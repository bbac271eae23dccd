#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>

#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Two outputs at four times, computed from two parameters; counts the samples over all clones. Fails where
/// p0 is a multiple of 7; throws, as a bug would, at `bug`.
class CountingSimulator : public Simulator {
 public:
  explicit CountingSimulator(std::function<void(double p0)> visit = {}, double bug = -1.0)
      : visit_(std::move(visit)), bug_(bug) {}

  const ResponseLayout& getLayout() const override { return layout_; }
  int getCount() const { return *count_; }

  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) override {
    for (Eigen::Index j = 0; j < parameters.cols(); ++j) {
      statuses[j] = simulateOne(parameters(0, j), parameters(1, j), responses.col(j));
      ++*count_;
      if (visit_) {
        visit_(parameters(0, j));
      }
    }
  }

  std::unique_ptr<Simulator> clone() const override { return std::make_unique<CountingSimulator>(*this); }

 private:
  SampleStatus simulateOne(double p0, double p1, Eigen::Ref<Eigen::VectorXd> response) const {
    if (p0 == bug_) {
      throw std::logic_error("a bug");
    }
    if (std::fmod(p0, 7.0) == 0.0) {
      response.setConstant(std::numeric_limits<double>::quiet_NaN());
      return {false, "p0 is a multiple of 7"};
    }
    for (Eigen::Index row = 0; row < response.size(); ++row) {
      response[row] = std::sin(p0 * static_cast<double>(row + 1)) + p1;
    }
    return {};
  }

  ResponseLayout layout_{{"a", "b"}, {"m", "rad"}, Eigen::VectorXd::LinSpaced(4, 1.0, 4.0), 0};
  std::function<void(double)> visit_;
  double bug_;
  std::shared_ptr<std::atomic<int>> count_ = std::make_shared<std::atomic<int>>(0);
};

/// Points (i + first + 1, i / 2).
inline Eigen::MatrixXd makeCountedPoints(int count, int first = 0) {
  Eigen::MatrixXd points(2, count);
  for (int i = 0; i < count; ++i) {
    points.col(i) << i + first + 1.0, 0.5 * (i + first);
  }
  return points;
}

}  // namespace twinmap
