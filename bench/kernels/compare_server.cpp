// The C++ side of bench/compare_sklearn.py: reads one command a line, does it, answers with one line of
// numbers. Times are medians, so that the script can alternate between the two programs.
//   data PATH N FEATURES               writes inputs (N x FEATURES), targets (N x 4) as raw doubles
//   evaluate N FEATURES ARD REPEATS    -> milliseconds per NLML + gradient, and the NLML
//   train N FEATURES STARTS THREADS    -> seconds for four targets, and their four NLMLs
//   online N FEATURES ARD REPEATS      -> microseconds, median and 99th percentile, for four means and
//   stddevs
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "bench/kernels/problem.hpp"
#include "kernels/gp/fit.hpp"
#include "kernels/gp/online/online_predictor.hpp"
#include "kernels/gp/training.hpp"

namespace twinmap::bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

template <typename Action>
double secondsOf(const Action& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double quantile(std::vector<double>& values, double level) {
  const auto rank = static_cast<std::ptrdiff_t>(level * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[rank];
}

void writeData(std::istream& arguments) {
  std::string path;
  int n = 0, features = 0;
  arguments >> path >> n >> features;
  const Problem problem = makeProblem(n, features);
  std::ofstream file(path, std::ios::binary);
  for (const MatrixXd* matrix : {&problem.inputs, &problem.targets}) {
    file.write(reinterpret_cast<const char*>(matrix->data()),
               static_cast<std::streamsize>(matrix->size() * sizeof(double)));
  }
  std::cout << n;
}

void evaluate(std::istream& arguments) {
  int n = 0, features = 0, per_feature = 0, repeats = 0;
  arguments >> n >> features >> per_feature >> repeats;
  const Problem problem = makeProblem(n, features);
  const gp::ModelStructure structure = makeStructure(features, per_feature != 0);
  const gp::Hyperparameters hyperparameters = makeHyperparameters(features, per_feature != 0);
  const gp::TrainingSet set(problem.inputs, structure);
  gp::LikelihoodWorkspace workspace(set);
  VectorXd gradient(gp::HyperparameterLayout(structure).count);
  const VectorXd target = problem.targets.row(0).transpose();
  std::vector<double> times;
  double nlml = 0.0;
  for (int i = 0; i < repeats; ++i) {
    times.push_back(
        1e3 * secondsOf([&] {
          nlml = gp::evaluateLikelihoodGradient(set, target, hyperparameters, workspace, gradient).nlml;
        }));
  }
  std::cout << quantile(times, 0.5) << ' ' << nlml;
}

void train(std::istream& arguments) {
  int n = 0, features = 0;
  gp::TrainingOptions options;
  arguments >> n >> features >> options.starts >> options.threads;
  const Problem problem = makeProblem(n, features);
  std::vector<gp::TrainingResult> results;
  std::cout << secondsOf(
      [&] { results = gp::train(problem.inputs, problem.targets, makeStructure(features, false), options); });
  for (const gp::TrainingResult& result : results) {
    std::cout << ' ' << result.gp->getNlml();
  }
}

void predictOnline(std::istream& arguments) {
  int n = 0, features = 0, per_feature = 0, repeats = 0;
  arguments >> n >> features >> per_feature >> repeats;
  const Problem problem = makeProblem(n, features);
  gp::TrainingOptions options;
  options.starts = 1;
  options.max_evaluations = 3;  // the time does not depend on the hyperparameters
  std::vector<gp::Process> processes;
  for (const auto& result :
       gp::train(problem.inputs, problem.targets, makeStructure(features, per_feature != 0), options)) {
    processes.push_back(result.gp);
  }
  const gp::OnlinePredictor predictor(processes);
  gp::OnlinePredictor::Workspace workspace(predictor);
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const VectorXd x = problem.inputs.col(i % n);
    times.push_back(1e6 * secondsOf([&] { predictor.predict(x, workspace); }));
  }
  std::cout << quantile(times, 0.5) << ' ' << quantile(times, 0.99);
}

}  // namespace
}  // namespace twinmap::bench

int main() {
  std::cout << std::setprecision(17);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream arguments(line);
    std::string command;
    arguments >> command;
    if (command == "data") {
      twinmap::bench::writeData(arguments);
    }
    if (command == "evaluate") {
      twinmap::bench::evaluate(arguments);
    }
    if (command == "train") {
      twinmap::bench::train(arguments);
    }
    if (command == "online") {
      twinmap::bench::predictOnline(arguments);
    }
    std::cout << std::endl;
  }
}
