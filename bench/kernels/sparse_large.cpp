// Four two-beam maps from 16000 samples, 15 features, m = 500, on 2 threads, against an
// exact process on 4000 of the samples. Prints times, the peak memory and the root mean square test errors.
//   kernels_sparse_large [samples] [inducing] [subset] [exact samples]
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <iostream>

#include "bench/kernels/problem.hpp"
#include "kernels/gp/sparse/sparse_training.hpp"
#include "kernels/gp/training.hpp"

namespace {

using namespace twinmap;
using Eigen::MatrixXd;

constexpr int kFeatures = 15;
constexpr int kTests = 1000;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double peakGibibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1048576.0;
}

double errorOf(const gp::Prediction& prediction, const MatrixXd& truth, int target) {
  return std::sqrt((prediction.mean - truth.row(target).transpose()).squaredNorm() / double(truth.cols()));
}

double coverageOf(const gp::Prediction& prediction, const MatrixXd& truth, int target) {
  const Eigen::ArrayXd error = (prediction.mean - truth.row(target).transpose()).array().abs();
  return (error <= 1.96 * prediction.stddev().array()).cast<double>().mean();
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
  const int n = argument(1, 16000);
  const bench::Problem all = bench::makeProblem(n + kTests, kFeatures);
  const MatrixXd inputs = all.inputs.leftCols(n), targets = all.targets.leftCols(n);
  const MatrixXd tests = all.inputs.rightCols(kTests), truth = all.targets.rightCols(kTests);
  gp::TrainingOptions options;
  options.threads = 2;
  gp::ModelStructure structure;
  structure.length_scale_groups = gp::oneGroupPerFeature(kFeatures);
  gp::SparseOptions sparse;
  sparse.inducing = argument(2, 500);
  sparse.subset = argument(3, 1000);

  double start = seconds();
  const auto results = gp::trainSparse(inputs, targets, structure, options, sparse);
  std::cout << "sparse: " << seconds() - start << " s, peak " << peakGibibytes() << " GiB" << std::endl;
  for (int t = 0; t < 4; ++t) {
    const auto prediction = results[t].gp->predict(tests);
    std::cout << "  target " << t << ": error " << errorOf(prediction, truth, t) << ", coverage "
              << coverageOf(prediction, truth, t) << ", bound " << results[t].subset_bound << " -> "
              << results[t].bound << ", inducing " << results[t].gp->getInducingCount() << "\n";
  }
  const int exact_samples = argument(4, 4000);
  if (exact_samples == 0) {
    return 0;
  }
  start = seconds();
  options.starts = 1;
  options.max_evaluations = 40;
  const auto exact =
      gp::train(inputs.leftCols(exact_samples), targets.leftCols(exact_samples), structure, options);
  std::cout << "exact on " << exact_samples << ": " << seconds() - start << " s, peak " << peakGibibytes()
            << " GiB" << std::endl;
  for (int t = 0; t < 4; ++t) {
    const auto prediction = exact[t].gp->predict(tests);
    std::cout << "  target " << t << ": error " << errorOf(prediction, truth, t) << ", coverage "
              << coverageOf(prediction, truth, t) << "\n";
  }
}
