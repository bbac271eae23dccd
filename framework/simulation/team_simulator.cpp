#include "framework/simulation/team_simulator.hpp"

#include <algorithm>
#include <chrono>

#include "framework/simulation/simulator_team.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Parameters = Eigen::Ref<const MatrixXd>;

/// Threads that wait for work keep their cores busy for some milliseconds: they are for what takes longer
/// (s).
constexpr double kWorthwhile = 0.02;
/// Fewer columns leave half of the lanes empty and take as long; with derivatives fewer run side by side.
constexpr Index kLeastShare = 8, kLeastWithDerivatives = 4;
/// More shares than threads, for threads that are slowed down by others; but few, since lanes run empty at
/// the end of each.
constexpr Index kMostShare = 64;

/// Columns of a share: as many shares for each of the threads.
Index calcShare(Index columns, Index threads, Index least) {
  const Index rounds = (columns + kMostShare * threads - 1) / (kMostShare * threads);
  const Index shares = rounds * threads;
  return std::max(least, (columns + shares - 1) / shares);
}

}  // namespace

TeamSimulator::TeamSimulator(std::unique_ptr<Simulator> own)
    : cost_{kLeastShare}, cost_with_derivatives_{kLeastWithDerivatives} {
  team_.push_back(std::move(own));
}

int TeamSimulator::makeTeam(Index columns, const Cost& cost) {
  if (cost.seconds * static_cast<double>(columns) < kWorthwhile) {
    return 1;
  }
  const Index most = (columns + cost.least - 1) / cost.least;
  const int threads = static_cast<int>(std::min<Index>(countThreads(), most));
  while (static_cast<int>(team_.size()) < threads) {
    team_.push_back(getOwn().clone());
  }
  return threads;
}

void TeamSimulator::run(Index columns, Cost& cost, const Part& part) {
  if (columns == 0) {
    return;
  }
  const int threads = makeTeam(columns, cost);
  const auto begin = std::chrono::steady_clock::now();
  if (threads == 1) {
    part(updOwn(), 0, columns);
  } else {
    const Index share = calcShare(columns, threads, cost.least);
    runOnTeam(team_, static_cast<int>((columns + share - 1) / share), threads,
              [&](Simulator& simulator, int i) {
                part(simulator, i * share, std::min(share, columns - i * share));
              });
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  cost.seconds = elapsed.count() * threads / static_cast<double>(columns);
}

void TeamSimulator::simulate(const Parameters& parameters, Eigen::Ref<MatrixXd> responses,
                             SampleStatus* statuses) {
  run(parameters.cols(), cost_, [&](Simulator& simulator, Index first, Index count) {
    simulator.simulate(parameters.middleCols(first, count), responses.middleCols(first, count),
                       statuses + first);
  });
}

void TeamSimulator::simulateWithDerivatives(const Parameters& parameters, Eigen::Ref<MatrixXd> responses,
                                            MatrixXd& derivatives, SampleStatus* statuses) {
  const Index all = parameters.cols(), sampled = parameters.rows();
  derivatives.resize(responses.rows(), all * sampled);
  run(all, cost_with_derivatives_, [&](Simulator& simulator, Index first, Index count) {
    if (count == all) {
      simulator.simulateWithDerivatives(parameters, responses, derivatives, statuses);
      return;
    }
    MatrixXd part;
    simulator.simulateWithDerivatives(parameters.middleCols(first, count), responses.middleCols(first, count),
                                      part, statuses + first);
    derivatives.middleCols(first * sampled, count * sampled) = part;
  });
}

std::unique_ptr<Simulator> shareAmongThreads(std::unique_ptr<Simulator> simulator) {
  if (simulator->getBatchSize() < kLeastShare) {
    return simulator;
  }
  return std::make_unique<TeamSimulator>(std::move(simulator));
}

}  // namespace twinmap
