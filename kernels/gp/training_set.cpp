#include "kernels/gp/training_set.hpp"

#include <stdexcept>
#include <string>

#include "kernels/linalg/gemm.hpp"

namespace twinmap::gp {
namespace {

void check_size(Eigen::Index samples, int coefficients) {
  const Eigen::Index least = std::max<Eigen::Index>(2, coefficients + 1);
  if (samples >= least) return;
  throw std::invalid_argument("a Gaussian process needs at least " + std::to_string(least) +
                              " training samples for this mean function; there are " +
                              std::to_string(samples));
}

Eigen::MatrixXd calc_gram(const Eigen::MatrixXd& centered) {
  const Eigen::Index n = centered.cols();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(linalg::padded(n), n);
  linalg::GemmScratch scratch;
  const linalg::ConstView z = linalg::view_of(centered);
  linalg::gemm(1.0, z.transposed(), z, 0.0, {gram.data(), n, n, gram.rows()}, scratch);
  return gram;
}

std::vector<int> explicit_groups(const ModelStructure& structure, Eigen::Index features) {
  if (!structure.length_scale_groups.empty()) return structure.length_scale_groups;
  return std::vector<int>(features, 0);
}

}  // namespace

Eigen::VectorXd calc_center(const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(inputs.rows());
  for (Eigen::Index i = 0; i < inputs.cols(); ++i) sum += inputs.col(i);
  return sum / static_cast<double>(inputs.cols());
}

Eigen::MatrixXd calc_mean_basis(MeanFunction mean, const Eigen::MatrixXd& centered) {
  if (mean == MeanFunction::kZero) return Eigen::MatrixXd(centered.cols(), 0);
  if (mean == MeanFunction::kConstant) return Eigen::MatrixXd::Ones(centered.cols(), 1);
  Eigen::MatrixXd basis(centered.cols(), centered.rows() + 1);
  basis.col(0).setOnes();
  basis.rightCols(centered.rows()) = centered.transpose();
  return basis;
}

TrainingSet::TrainingSet(const Eigen::Ref<const Eigen::MatrixXd>& inputs, const ModelStructure& structure)
    : structure_(structure), inputs_(std::make_shared<const Eigen::MatrixXd>(inputs)) {
  check_inputs(inputs, "training inputs");
  check_structure(structure, inputs.rows());
  check_size(inputs.cols(), mean_coefficient_count(structure, inputs.rows()));
  const Eigen::MatrixXd centered = inputs_->colwise() - calc_center(*inputs_);
  distances_.emplace(centered, explicit_groups(structure, inputs.rows()), group_count(structure));
  if (structure.linear_term) gram_ = calc_gram(centered);
  mean_basis_ = calc_mean_basis(structure.mean, centered);
}

}  // namespace twinmap::gp
