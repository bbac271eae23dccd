#include "framework/inference/clock/clocked_simulator.hpp"

#include <algorithm>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

double ClockedSimulator::Times::calcTrueTime(double stamp) const {
  return std::clamp(stamp - calcLateness(faults, stamp), reach, duration - reach);
}

bool ClockedSimulator::Times::isWithin(double stamp) const {
  const double time = stamp - calcLateness(faults, stamp);
  return time >= reach && time <= duration - reach;
}

VectorXd ClockedSimulator::Times::listAll() const {
  std::vector<double> all;
  for (const double stamp : stamps) {
    const double time = calcTrueTime(stamp);
    all.insert(all.end(), {time - reach, time, time + reach});
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return Eigen::Map<const VectorXd>(all.data(), static_cast<Index>(all.size()));
}

ClockedSimulator::ClockedSimulator(std::unique_ptr<Simulator> inner, Times times, Index before)
    : inner_(std::move(inner)), times_(std::move(times)), before_(before), layout_(inner_->getLayout()) {
  layout_.times = times_.stamps;
  const VectorXd& all = inner_->getLayout().times;
  shapes_.resize(times_.stamps.size(), static_cast<Index>(times_.faults.size()));
  for (Index i = 0; i < times_.stamps.size(); ++i) {
    const double time = times_.calcTrueTime(times_.stamps[i]);
    const auto find = [&](double at) -> Index {
      return std::lower_bound(all.begin(), all.end(), at) - all.begin();
    };
    nodes_.push_back({find(time - times_.reach), find(time), find(time + times_.reach)});
    for (Index k = 0; k < shapes_.cols(); ++k) {
      shapes_(i, k) = calcShape(times_.faults[static_cast<std::size_t>(k)], times_.stamps[i]);
    }
  }
}

MatrixXd ClockedSimulator::takeInner(const Ref<const MatrixXd>& parameters) const {
  const Index own = shapes_.cols(), after = parameters.rows() - before_ - own;
  MatrixXd inner(before_ + after, parameters.cols());
  inner << parameters.topRows(before_), parameters.bottomRows(after);
  return inner;
}

double ClockedSimulator::calcMore(Index time, const Ref<const VectorXd>& sizes) const {
  double more = 0.0;
  for (Index k = 0; k < sizes.size(); ++k) {
    more += shapes_(time, k) * (sizes[k] - times_.faults[static_cast<std::size_t>(k)].value);
  }
  return more;
}

ClockedSimulator::Weights ClockedSimulator::calcWeights(double shift) const {
  const double x = shift / times_.reach;
  return {0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)};
}

ClockedSimulator::Weights ClockedSimulator::calcSlopes(double shift) const {
  const double x = shift / times_.reach;
  return {(x - 0.5) / times_.reach, -2.0 * x / times_.reach, (x + 0.5) / times_.reach};
}

double ClockedSimulator::apply(const Weights& weights, const Ref<const VectorXd>& inner, Index output,
                               Index time) const {
  const ResponseLayout& layout = inner_->getLayout();
  const auto& [before, at, after] = nodes_[static_cast<std::size_t>(time)];
  return weights.before * inner[layout.getRow(output, before)] +
         weights.at * inner[layout.getRow(output, at)] + weights.after * inner[layout.getRow(output, after)];
}

void ClockedSimulator::combine(const Ref<const MatrixXd>& inner, const Ref<const MatrixXd>& parameters,
                               Ref<MatrixXd> responses) const {
  for (Index j = 0; j < inner.cols(); ++j) {
    const VectorXd sizes = parameters.col(j).segment(before_, shapes_.cols());
    for (Index i = 0; i < layout_.times.size(); ++i) {
      const Weights weights = calcWeights(-calcMore(i, sizes));
      for (Index output = 0; output < layout_.getOutputCount(); ++output) {
        responses(layout_.getRow(output, i), j) = apply(weights, inner.col(j), output, i);
      }
    }
  }
}

void ClockedSimulator::simulate(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                SampleStatus* statuses) {
  MatrixXd inner(inner_->getLayout().getRowCount(), parameters.cols());
  inner_->simulate(takeInner(parameters), inner, statuses);
  combine(inner, parameters, responses);
}

void ClockedSimulator::simulateAround(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                      SampleStatus* statuses) {
  MatrixXd inner(inner_->getLayout().getRowCount(), parameters.cols());
  inner_->simulateAround(takeInner(parameters), inner, statuses);
  combine(inner, parameters, responses);
}

void ClockedSimulator::simulateWithDerivatives(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                               MatrixXd& derivatives, SampleStatus* statuses) {
  const MatrixXd points = takeInner(parameters);
  const Index p = parameters.rows(), own = shapes_.cols(), inner_p = points.rows();
  MatrixXd inner(inner_->getLayout().getRowCount(), parameters.cols()), inner_derivatives;
  inner_->simulateWithDerivatives(points, inner, inner_derivatives, statuses);
  combine(inner, parameters, responses);
  derivatives.resize(layout_.getRowCount(), parameters.cols() * p);
  for (Index j = 0; j < parameters.cols(); ++j) {
    for (Index k = 0; k < inner_p; ++k) {
      combine(inner_derivatives.col(j * inner_p + k), parameters.col(j),
              derivatives.col(j * p + (k < before_ ? k : k + own)));
    }
    const VectorXd sizes = parameters.col(j).segment(before_, own);
    for (Index i = 0; i < layout_.times.size(); ++i) {
      const Weights slopes = calcSlopes(-calcMore(i, sizes));
      for (Index output = 0; output < layout_.getOutputCount(); ++output) {
        const double slope = apply(slopes, inner.col(j), output, i);
        for (Index k = 0; k < own; ++k) {
          derivatives(layout_.getRow(output, i), j * p + before_ + k) = -slope * shapes_(i, k);
        }
      }
    }
  }
}

std::unique_ptr<Simulator> ClockedSimulator::clone() const {
  return std::make_unique<ClockedSimulator>(inner_->clone(), times_, before_);
}

}  // namespace twinmap
