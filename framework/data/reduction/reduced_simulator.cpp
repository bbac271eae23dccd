#include "framework/data/reduction/reduced_simulator.hpp"

#include <algorithm>
#include <limits>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;

namespace {

void reduceColumns(const ResponseReduction& reduction, const MatrixXd& whole, const SampleStatus* statuses,
                   Ref<MatrixXd> reduced) {
  for (Index i = 0; i < whole.cols(); ++i) {
    if (statuses[i].ok) {
      reduced.col(i) = reduction.reduce(whole.col(i));
    } else {
      reduced.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
}

}  // namespace

ReducedSimulator::ReducedSimulator(std::unique_ptr<Simulator> whole,
                                   std::shared_ptr<const ResponseReduction> reduction)
    : whole_(std::move(whole)), reduction_(std::move(reduction)) {}

Index ReducedSimulator::countAtOnce(Index derivatives) const {
  constexpr Index kNumbers = 20 << 20;
  return std::max<Index>(1, kNumbers / (whole_->getLayout().getRowCount() * (1 + derivatives)));
}

void ReducedSimulator::simulate(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                SampleStatus* statuses) {
  const Index most = countAtOnce(0);
  for (Index first = 0; first < parameters.cols(); first += most) {
    const Index count = std::min(most, parameters.cols() - first);
    MatrixXd whole(whole_->getLayout().getRowCount(), count);
    whole_->simulate(parameters.middleCols(first, count), whole, statuses + first);
    reduceColumns(*reduction_, whole, statuses + first, responses.middleCols(first, count));
  }
}

void ReducedSimulator::simulateAround(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                      SampleStatus* statuses) {
  MatrixXd whole(whole_->getLayout().getRowCount(), parameters.cols());
  whole_->simulateAround(parameters, whole, statuses);
  reduceColumns(*reduction_, whole, statuses, responses);
}

void ReducedSimulator::simulateWithDerivatives(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                               MatrixXd& derivatives, SampleStatus* statuses) {
  const Index p = parameters.rows(), most = countAtOnce(p);
  derivatives.resize(getLayout().getRowCount(), parameters.cols() * p);
  for (Index first = 0; first < parameters.cols(); first += most) {
    const Index count = std::min(most, parameters.cols() - first);
    MatrixXd whole(whole_->getLayout().getRowCount(), count), slopes;
    whole_->simulateWithDerivatives(parameters.middleCols(first, count), whole, slopes, statuses + first);
    reduceColumns(*reduction_, whole, statuses + first, responses.middleCols(first, count));
    for (Index i = 0; i < count; ++i) {
      if (statuses[first + i].ok) {
        derivatives.middleCols((first + i) * p, p) =
            reduction_->reduceDerivatives(whole.col(i), slopes.middleCols(i * p, p));
      }
    }
  }
}

std::unique_ptr<Simulator> ReducedSimulator::clone() const {
  return std::make_unique<ReducedSimulator>(whole_->clone(), reduction_);
}

std::unique_ptr<Simulator> ReducedSimulator::clonePrecisely() const {
  std::unique_ptr<Simulator> precise = whole_->clonePrecisely();
  return precise ? std::make_unique<ReducedSimulator>(std::move(precise), reduction_) : nullptr;
}

}  // namespace twinmap
