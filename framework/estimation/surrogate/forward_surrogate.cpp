#include "framework/estimation/surrogate/forward_surrogate.hpp"

#include "kernels/exact/exact.hpp"

namespace twinmap {

Eigen::MatrixXd ForwardSurrogate::calcScores(const Eigen::MatrixXd& features) const {
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(getScoreCount(), features.cols());
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    for (Eigen::Index j = 0; j < features.rows(); ++j) {
      exact::addMultiple(static_cast<int>(found.rows()), features(j, i) - center(j), projection.col(j).data(),
                         found.col(i).data());
    }
  }
  return found;
}

void ForwardSurrogate::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& at,
                                const std::vector<double>& widening,
                                std::vector<gp::SharedProcess::Workspace>& workspaces,
                                Eigen::MatrixXd& values, Eigen::MatrixXd& stddev) const {
  values.resize(getScoreCount(), at.cols());
  stddev.resize(getScoreCount(), at.cols());
  Eigen::Index first = 0;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const Eigen::Index count = windows[w].getFunctionCount();
    windows[w].evaluateMany(at, values.middleRows(first, count), stddev.middleRows(first, count),
                            workspaces[w]);
    stddev.middleRows(first, count) *= widening[w];
    first += count;
  }
}

}  // namespace twinmap
