#include "framework/estimation/refined/thinned_misfit.hpp"

#include <algorithm>
#include <limits>

#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd ThinnedMisfit::calcResidual(const VectorXd& response) const {
  return samples_.scale.cwiseProduct(samples_.measured - response(samples_.rows));
}

std::vector<LocalMisfit> ThinnedMisfit::linearizeAll(const MatrixXd& points) {
  const MatrixXd sampled = box_.makePoints(points);
  const SearchedParameters& searched = box_.getSearched();
  MatrixXd responses(simulator_->getLayout().getRowCount(), points.cols()), derivatives;
  std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
  simulator_->simulateWithDerivatives(sampled, responses, derivatives, statuses.data());
  simulations_ += static_cast<int>(points.cols());
  std::vector<LocalMisfit> all(statuses.size());
  for (Index i = 0; i < points.cols(); ++i) {
    LocalMisfit& local = all[static_cast<std::size_t>(i)];
    local.status = statuses[static_cast<std::size_t>(i)];
    if (local.status.ok) {
      local.at = points.col(i);
      local.residual = calcResidual(responses.col(i));
      local.residuals = local.residual.size();
      const auto own = Eigen::seqN(i * sampled.rows() + searched.first, searched.count);
      local.jacobian =
          samples_.scale.asDiagonal() * derivatives(samples_.rows, own) * box_.getHalfWidths().asDiagonal();
      local.information = local.jacobian.transpose() * local.jacobian;
      local.descent = local.jacobian.transpose() * local.residual - kHalfWidthInformation * local.at;
      local.chi_square = local.residual.squaredNorm();
      local.misfit = local.chi_square + kHalfWidthInformation * local.at.squaredNorm();
    }
  }
  return all;
}

VectorXd ThinnedMisfit::evaluate(const MatrixXd& points) {
  MatrixXd responses(simulator_->getLayout().getRowCount(), points.cols());
  std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
  simulator_->simulate(box_.makePoints(points), responses, statuses.data());
  simulations_ += static_cast<int>(points.cols());
  VectorXd misfits(points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    misfits[i] = statuses[static_cast<std::size_t>(i)].ok
                     ? calcResidual(responses.col(i)).squaredNorm() +
                           kHalfWidthInformation * points.col(i).squaredNorm()
                     : std::numeric_limits<double>::infinity();
  }
  return misfits;
}

VectorXd chooseTimes(const ResponseLayout& layout, Index features, Index unknown) {
  const Index every = features / std::max<Index>(1, kPerUnknown * unknown);
  if (every < 2) {
    return {};
  }
  std::vector<Index> kept;
  for (Index i = every / 2; i < layout.times.size(); i += every) {
    kept.push_back(i);
  }
  return layout.times(kept);
}

}  // namespace twinmap
