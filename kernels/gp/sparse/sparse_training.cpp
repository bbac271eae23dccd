#include "kernels/gp/sparse/sparse_training.hpp"

#include <omp.h>

#include <stdexcept>
#include <utility>

#include "kernels/gp/optimizer.hpp"
#include "kernels/gp/sparse/inducing_points.hpp"
#include "kernels/gp/starts.hpp"
#include "kernels/gp/training_set.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Inducing inputs chosen, hyperparameters refined, and both once more: the better hyperparameters choose
// better.
constexpr int kRounds = 2;

void checkSparseOptions(const SparseOptions& sparse, const ModelStructure& structure) {
  const auto require = [](bool condition, const char* rule) {
    if (!condition) {
      throw std::invalid_argument(std::string("SparseOptions: ") + rule);
    }
  };
  require(sparse.inducing >= 1, "inducing must be at least 1");
  require(sparse.subset >= 2, "subset must be at least 2");
  require(sparse.refine_evaluations >= 0, "refine_evaluations must not be negative");
  require(!structure.linear_term, "sparse processes have no linear covariance term; use a linear mean");
}

MatrixXd selectColumns(const Eigen::Ref<const MatrixXd>& matrix, const std::vector<Index>& indices) {
  MatrixXd selected(matrix.rows(), static_cast<Index>(indices.size()));
  for (Index i = 0; i < selected.cols(); ++i) {
    selected.col(i) = matrix.col(indices[i]);
  }
  return selected;
}

// What the processes of all targets share.
struct SharedTraining {
  const MatrixXd& inputs;
  const MatrixXd& subset;  // of the inputs
  const ModelStructure& structure;
  const TrainingOptions& options;
  const SparseOptions& sparse;
};

// The search box of the subset's scales, so that both searches know the same bounds.
Hyperparameters refine(const SharedTraining& shared, const VariationalBound& bound, const VectorXd& target,
                       const Hyperparameters& start, SparseTrainingResult& result) {
  const ModelStructure& structure = shared.structure;
  const TrainingSet set(shared.subset, structure);
  const double stddev = std::sqrt((target.array() - target.mean()).square().mean());
  const SearchBox box = makeSearchBox(set, calcDataScales(set), stddev, shared.options);
  const Objective objective = [&](const VectorXd& point, VectorXd& gradient) {
    return bound.evaluate(fromLog(structure, point), gradient);
  };
  const SearchResult found = minimize(
      objective, target.size(), toLog(structure, start), box,
      {shared.sparse.refine_evaluations / kRounds, shared.options.tolerance, nullptr, shared.options.stop});
  result.refine_evaluations += found.evaluations;
  return std::isfinite(found.objective) ? fromLog(structure, found.end) : start;
}

void fitSparse(const SharedTraining& shared, const VectorXd& target, const Hyperparameters& start,
               SparseTrainingResult& result) {
  const StopFlag stop = shared.options.stop;
  SparseGaussianProcessParts parts{shared.structure, start, calcCenter(shared.inputs), {}, {}};
  bool definite = true;
  for (int round = 0; round < kRounds && definite && !isStopRequested(stop); ++round) {
    parts.inducing =
        chooseInducingPoints(shared.inputs, shared.structure, parts.hyperparameters, shared.sparse.inducing);
    const VariationalBound bound(shared.inputs, target, parts.inducing, shared.structure);
    if (round == 0 && bound.calcPosterior(start, parts.posterior)) {
      result.subset_bound = parts.posterior.bound;
    }
    if (shared.sparse.refine_evaluations >= kRounds) {
      parts.hyperparameters = refine(shared, bound, target, parts.hyperparameters, result);
    }
    definite = bound.calcPosterior(parts.hyperparameters, parts.posterior);
  }
  if (isStopRequested(stop)) {
    return;
  }
  if (!definite) {
    result.status = TrainingStatus::kFailed;
    result.message =
        "the inducing inputs' covariance is not positive definite: raise the noise's lower bound";
    return;
  }
  result.bound = parts.posterior.bound;
  result.gp = std::make_shared<const SparseGaussianProcess>(std::move(parts));
}

}  // namespace

std::vector<SparseTrainingResult> trainSparse(const Eigen::Ref<const MatrixXd>& inputs,
                                              const Eigen::Ref<const MatrixXd>& targets,
                                              const ModelStructure& structure, const TrainingOptions& options,
                                              const SparseOptions& sparse) {
  checkSparseOptions(sparse, structure);
  checkInputs(inputs, "train_sparse: inputs");
  checkInputs(targets, "train_sparse: targets");
  if (targets.cols() != inputs.cols()) {
    throw std::invalid_argument("train_sparse: the targets have " + std::to_string(targets.cols()) +
                                " columns for " + std::to_string(inputs.cols()) + " training samples");
  }
  const std::vector<Index> indices = spreadIndices(inputs.cols(), sparse.subset);
  const MatrixXd all = inputs, subset = selectColumns(inputs, indices);
  const SharedTraining shared{all, subset, structure, options, sparse};
  const auto exact = train(subset, selectColumns(targets, indices), structure, options);
  std::vector<SparseTrainingResult> results(exact.size());
  const int count = static_cast<int>(exact.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(std::max(1, std::min(options.threads, count)))
  for (int t = 0; t < count; ++t) {
    results[t].status = exact[t].status;
    results[t].message = exact[t].message;
    results[t].subset_report = exact[t].report;
    if (!exact[t].gp) {
      continue;
    }
    const VectorXd target = targets.row(t).transpose();
    fitSparse(shared, target, exact[t].gp->getHyperparameters(), results[t]);
  }
  throwIfStopped(options.stop);
  return results;
}

}  // namespace twinmap::gp
