#include "kernels/gp/covariance/distances.hpp"

#include <algorithm>
#include <utility>

#include "kernels/gp/covariance/columns.hpp"

namespace twinmap::gp {

using Eigen::Index;
using linalg::padded;

namespace {

// Columns of the triangular operand taken at a time: few enough to multiply few of its zeros, many enough for
// the products to run at full speed.
constexpr Index kPanel = 128;

}  // namespace

SquaredDistances::SquaredDistances(const Eigen::MatrixXd& inputs, std::vector<int> groups, int group_count)
    : inputs_(inputs), groups_(std::move(groups)), group_count_(group_count) {
  if (isStored()) {
    storeGroups();
  }
}

SquaredDistances::Workspace::Workspace(const SquaredDistances& distances) {
  if (distances.isStored()) {
    return;
  }
  const Index n = distances.size();
  const Index d = distances.inputs_.rows();
  scaled.setZero(padded(d), n);
  product.setZero(padded(d), n);
  squared_norms.setZero(padded(n));
  row_sums.setZero(n);
  feature_sums.setZero(padded(d));
}

void SquaredDistances::storeGroups() {
  const Index n = size();
  const Eigen::MatrixXd by_sample = inputs_.transpose();  // a feature's values are contiguous
  stored_.assign(group_count_, Eigen::MatrixXd::Zero(padded(n), n));
  for (Index j = 0; j < n; ++j) {
    for (Index f = 0; f < inputs_.rows(); ++f) {
      auto below = stored_[groups_[f]].col(j).segment(j + 1, n - j - 1).array();
      below += (by_sample.col(f).tail(n - j - 1).array() - by_sample(j, f)).square();
    }
  }
}

void SquaredDistances::calc(const Eigen::VectorXd& length_scales, linalg::View q, Workspace& workspace,
                            linalg::TriangularScratch& scratch) const {
  if (isStored()) {
    return calcFromGroups(length_scales, q);
  }
  calcFromProduct(length_scales, q, workspace, scratch);
}

void SquaredDistances::contract(const Eigen::VectorXd& length_scales, linalg::View t, Workspace& workspace,
                                linalg::TriangularScratch& scratch, Eigen::VectorXd& sums) const {
  if (isStored()) {
    return contractGroups(length_scales, t, sums);
  }
  contractProduct(t, workspace, scratch, sums);
}

void SquaredDistances::calcFromGroups(const Eigen::VectorXd& length_scales, linalg::View q) const {
  for (Index j = 0; j < size(); ++j) {
    AlignedColumn column = lowerColumn(q, j);
    column = lowerColumn(stored_[0], j) / (length_scales(0) * length_scales(0));
    for (int g = 1; g < group_count_; ++g) {
      column += lowerColumn(stored_[g], j) / (length_scales(g) * length_scales(g));
    }
  }
}

void SquaredDistances::calcFromProduct(const Eigen::VectorXd& length_scales, linalg::View q,
                                       Workspace& workspace, linalg::TriangularScratch& scratch) const {
  const Index n = size();
  const Index d = inputs_.rows();
  for (Index f = 0; f < d; ++f) {
    workspace.feature_sums(f) = 1.0 / length_scales(groups_[f]);
  }
  for (Index i = 0; i < n; ++i) {
    workspace.scaled.col(i).head(d) = inputs_.col(i).cwiseProduct(workspace.feature_sums.head(d));
    workspace.squared_norms(i) = workspace.scaled.col(i).squaredNorm();
  }
  const linalg::ConstView z{workspace.scaled.data(), d, n, 1, workspace.scaled.rows()};
  scratch.multiply(-2.0, z.transposed(), z, 0.0, q, linalg::Part::kLower);
  for (Index j = 0; j < n; ++j) {
    AlignedColumn column = lowerColumn(q, j);
    column += ConstAlignedColumn(workspace.squared_norms.data() + firstOfLine(j), column.size());
    column = (column + workspace.squared_norms(j)).max(0.0);
    clearOutsideStrictLower(q, j);
  }
}

void SquaredDistances::contractGroups(const Eigen::VectorXd& length_scales, linalg::View t,
                                      Eigen::VectorXd& sums) const {
  for (int g = 0; g < group_count_; ++g) {
    double sum = 0.0;
    for (Index j = 0; j < size(); ++j) {
      sum += (lowerColumn(t, j) * lowerColumn(stored_[g], j)).sum();
    }
    sums(g) = sum / (length_scales(g) * length_scales(g));
  }
}

void SquaredDistances::contractProduct(linalg::View t, Workspace& workspace,
                                       linalg::TriangularScratch& scratch, Eigen::VectorXd& sums) const {
  const Index n = size();
  const Index d = inputs_.rows();
  const linalg::ConstView z{workspace.scaled.data(), d, n, 1, workspace.scaled.rows()};
  const linalg::View product{workspace.product.data(), d, n, workspace.product.rows()};
  for (Index j = 0; j < n; j += kPanel) {
    const Index width = std::min(kPanel, n - j);
    scratch.multiply(1.0, z.block(0, j, d, n - j), t.block(j, j, n - j, width), 0.0,
                     product.block(0, j, d, width));
  }
  workspace.row_sums.setZero();
  for (Index j = 0; j < n; ++j) {
    const Eigen::Map<const Eigen::VectorXd> below(t.col(j) + j, n - j);
    workspace.row_sums.tail(n - j) += below;
    workspace.row_sums(j) += lowerColumn(t, j).sum();
  }
  workspace.feature_sums.setZero();
  for (Index i = 0; i < n; ++i) {
    workspace.feature_sums.array() +=
        workspace.scaled.col(i).array() *
        (workspace.row_sums(i) * workspace.scaled.col(i).array() - 2.0 * workspace.product.col(i).array());
  }
  sums.head(group_count_).setZero();
  for (Index f = 0; f < d; ++f) {
    sums(groups_[f]) += workspace.feature_sums(f);
  }
}

}  // namespace twinmap::gp
