#include "framework/simulation/parallel_simulator.hpp"

#include <omp.h>

#include <algorithm>

#include "framework/simulation/simulator_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;

ParallelSimulator::ParallelSimulator(std::unique_ptr<Simulator> simulator) {
  simulators_.push_back(std::move(simulator));
}

template <class Task>
void ParallelSimulator::share(Index columns, const Task& task) {
  // as many as run side by side in one thread, or several of these; two parts a thread even out what a part
  // takes longer
  constexpr Index kSmallest = 8, kPartsOfThread = 2;
  const Index threads = omp_in_parallel() != 0 ? 1 : omp_get_max_threads();
  const Index wanted = (columns + kPartsOfThread * threads - 1) / (kPartsOfThread * threads);
  const Index size = threads == 1 ? columns : (wanted + kSmallest - 1) / kSmallest * kSmallest;
  if (size >= columns) {
    task(first(), 0, columns);
    return;
  }
  while (static_cast<Index>(simulators_.size()) < threads) {
    simulators_.push_back(first().clone());
  }
  runInTeam(static_cast<int>((columns + size - 1) / size), static_cast<int>(threads),
            [&](int part, int thread) {
              const Index begin = part * size;
              task(*simulators_[static_cast<std::size_t>(thread)], begin, std::min(size, columns - begin));
            });
}

void ParallelSimulator::simulate(const Ref<const MatrixXd>& parameters, Ref<MatrixXd> responses,
                                 SampleStatus* statuses) {
  share(parameters.cols(), [&](Simulator& simulator, Index begin, Index count) {
    simulator.simulate(parameters.middleCols(begin, count), responses.middleCols(begin, count),
                       statuses + begin);
  });
}

void ParallelSimulator::simulateWithDerivatives(const Ref<const MatrixXd>& parameters,
                                                Ref<MatrixXd> responses, MatrixXd& derivatives,
                                                SampleStatus* statuses) {
  const Index sampled = parameters.rows();
  derivatives.resize(getLayout().getRowCount(), parameters.cols() * sampled);
  share(parameters.cols(), [&](Simulator& simulator, Index begin, Index count) {
    MatrixXd own;
    simulator.simulateWithDerivatives(parameters.middleCols(begin, count), responses.middleCols(begin, count),
                                      own, statuses + begin);
    derivatives.middleCols(begin * sampled, count * sampled) = own;
  });
}

std::unique_ptr<Simulator> ParallelSimulator::clone() const {
  return std::make_unique<ParallelSimulator>(first().clone());
}

std::unique_ptr<Simulator> ParallelSimulator::clonePrecisely() const {
  std::unique_ptr<Simulator> precise = first().clonePrecisely();
  return precise ? std::make_unique<ParallelSimulator>(std::move(precise)) : nullptr;
}

}  // namespace twinmap
