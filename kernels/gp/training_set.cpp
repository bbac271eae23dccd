#include "kernels/gp/training_set.hpp"

#include <stdexcept>
#include <string>

#include "kernels/linalg/gemm.hpp"

namespace twinmap::gp {
namespace {

void checkSize(Eigen::Index samples, int coefficients) {
  const Eigen::Index least = std::max<Eigen::Index>(2, coefficients + 1);
  if (samples >= least) {
    return;
  }
  throw std::invalid_argument("a Gaussian process needs at least " + std::to_string(least) +
                              " training samples for this mean function; there are " +
                              std::to_string(samples));
}

Eigen::MatrixXd calcGram(const Eigen::MatrixXd& centered) {
  const Eigen::Index n = centered.cols();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(linalg::padded(n), n);
  linalg::GemmScratch scratch;
  const linalg::ConstView z = linalg::viewOf(centered);
  linalg::gemm(1.0, z.transposed(), z, 0.0, {gram.data(), n, n, gram.rows()}, scratch);
  return gram;
}

std::vector<int> explicitGroups(const ModelStructure& structure, Eigen::Index features) {
  if (!structure.length_scale_groups.empty()) {
    return structure.length_scale_groups;
  }
  return std::vector<int>(features, 0);
}

}  // namespace

Eigen::VectorXd calcCenter(const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(inputs.rows());
  for (Eigen::Index i = 0; i < inputs.cols(); ++i) {
    sum += inputs.col(i);
  }
  return sum / static_cast<double>(inputs.cols());
}

Eigen::MatrixXd calcMeanBasis(MeanFunction mean, const Eigen::MatrixXd& centered) {
  if (mean == MeanFunction::kZero) {
    return Eigen::MatrixXd(centered.cols(), 0);
  }
  if (mean == MeanFunction::kConstant) {
    return Eigen::MatrixXd::Ones(centered.cols(), 1);
  }
  Eigen::MatrixXd basis(centered.cols(), centered.rows() + 1);
  basis.col(0).setOnes();
  basis.rightCols(centered.rows()) = centered.transpose();
  return basis;
}

TrainingSet::TrainingSet(const Eigen::Ref<const Eigen::MatrixXd>& inputs, const ModelStructure& structure)
    : structure_(structure), inputs_(std::make_shared<const Eigen::MatrixXd>(inputs)) {
  checkInputs(inputs, "training inputs");
  checkStructure(structure, inputs.rows());
  checkSize(inputs.cols(), getMeanCoefficientCount(structure, inputs.rows()));
  const Eigen::MatrixXd centered = inputs_->colwise() - calcCenter(*inputs_);
  distances_.emplace(centered, explicitGroups(structure, inputs.rows()), getGroupCount(structure));
  if (structure.linear_term) {
    gram_ = calcGram(centered);
  }
  mean_basis_ = calcMeanBasis(structure.mean, centered);
}

}  // namespace twinmap::gp
