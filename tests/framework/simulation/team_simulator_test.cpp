#include "framework/simulation/team_simulator.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Parameters = Eigen::Ref<const MatrixXd>;

/// Two rows p0 p1 and p0 - p1, whose derivatives are known; fails where p0 is 0, throws where it is -1.
class Products final : public Simulator {
 public:
  explicit Products(int batch = 128) : batch_(batch) {}

  const ResponseLayout& getLayout() const override { return layout_; }
  int getBatchSize() const override { return batch_; }
  bool hasDerivatives() const override { return true; }

  void simulate(const Parameters& parameters, Eigen::Ref<MatrixXd> responses,
                SampleStatus* statuses) override {
    ++calls;
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms * parameters.cols() / 10));
    for (Index j = 0; j < parameters.cols(); ++j) {
      const double p = parameters(0, j), q = parameters(1, j);
      if (p == -1.0) {
        throw std::logic_error("a bug");
      }
      statuses[j] = p == 0.0 ? SampleStatus{false, "p is zero"} : SampleStatus{};
      responses.col(j) << p * q, p - q;
    }
  }

  void simulateWithDerivatives(const Parameters& parameters, Eigen::Ref<MatrixXd> responses,
                               MatrixXd& derivatives, SampleStatus* statuses) override {
    simulate(parameters, responses, statuses);
    derivatives.resize(2, 2 * parameters.cols());
    for (Index j = 0; j < parameters.cols(); ++j) {
      derivatives.middleCols(2 * j, 2) << parameters(1, j), parameters(0, j), 1.0, -1.0;
    }
  }

  std::unique_ptr<Simulator> clone() const override { return std::make_unique<Products>(*this); }

  static inline std::atomic<int> calls{0};
  static inline int delay_ms = 4;  ///< of ten columns: 64 of them are worth more than one thread

 private:
  int batch_;
  ResponseLayout layout_{{"y", "z"}, {"m", "m"}, Eigen::VectorXd::Ones(1)};
};

class Threads {
 public:
  explicit Threads(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
  ~Threads() { omp_set_num_threads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  const int before_;
};

MatrixXd makePoints(Index count) {
  return MatrixXd::NullaryExpr(2, count, [](Index i, Index j) {
    return 1.0 + 0.25 * static_cast<double>(j) - static_cast<double>(i);
  });
}

struct Simulated {
  MatrixXd responses, derivatives;
  std::vector<SampleStatus> statuses;
};

Simulated simulate(Simulator& simulator, const MatrixXd& points) {
  const auto count = static_cast<std::size_t>(points.cols());
  Simulated result{MatrixXd(2, points.cols()), {}, std::vector<SampleStatus>(count)};
  simulator.simulateWithDerivatives(points, result.responses, result.derivatives, result.statuses.data());
  MatrixXd again(2, points.cols());
  simulator.simulate(points, again, result.statuses.data());
  EXPECT_EQ(again, result.responses);
  return result;
}

TEST(TeamSimulator, GivesWhatOneThreadGives) {
  for (const Index count : {1, 23, 64, 150}) {
    const MatrixXd points = makePoints(count);
    Products alone;
    const Simulated expected = simulate(alone, points);
    for (const int threads : {2, 3, 5}) {
      const Threads offered(threads);
      TeamSimulator team(std::make_unique<Products>());
      simulate(team, points);
      const Simulated found = simulate(team, points);
      EXPECT_EQ(found.responses, expected.responses) << count << " columns, " << threads << " threads";
      EXPECT_EQ(found.derivatives, expected.derivatives) << count << " columns, " << threads << " threads";
    }
  }
}

TEST(TeamSimulator, KeepsFailuresInTheirPlaces) {
  const Threads offered(2);
  MatrixXd points = makePoints(40);
  points(0, 31) = 0.0;
  TeamSimulator team(std::make_unique<Products>());
  simulate(team, points);
  const Simulated found = simulate(team, points);
  for (std::size_t j = 0; j < found.statuses.size(); ++j) {
    EXPECT_EQ(found.statuses[j].ok, j != 31) << j;
  }
}

TEST(TeamSimulator, AsksThreadsOnlyForWhatTakesLong) {
  const Threads offered(2);
  for (const int delay_ms : {0, 4}) {
    Products::delay_ms = delay_ms;
    int fewest = 1000;
    for (int attempt = 0; attempt < 5; ++attempt) {  // a busy machine makes a short one long now and then
      TeamSimulator team(std::make_unique<Products>());
      simulate(team, makePoints(64));
      Products::calls = 0;
      simulate(team, makePoints(64));
      fewest = std::min<int>(fewest, Products::calls);
    }
    EXPECT_EQ(fewest > 2, delay_ms > 0);
  }
}

TEST(TeamSimulator, ThrowsWhatOneOfItsTeamThrows) {
  const Threads offered(2);
  MatrixXd points = makePoints(40), responses(2, 40);
  points(0, 39) = -1.0;
  std::vector<SampleStatus> statuses(40);
  TeamSimulator team(std::make_unique<Products>());
  simulate(team, makePoints(40));
  EXPECT_THROW(team.simulate(points, responses, statuses.data()), std::logic_error);
}

TEST(TeamSimulator, SimulatesByItselfInAParallelRegion) {
  const Threads offered(2);
  const MatrixXd points = makePoints(64);
  Products::calls = 0;
#pragma omp parallel num_threads(2)
  {
    TeamSimulator team(std::make_unique<Products>());
    simulate(team, points);
    simulate(team, points);
  }
  EXPECT_EQ(Products::calls, 2 * 4);
}

TEST(TeamSimulator, IsMadeOfWhatTakesManyColumnsAtOnce) {
  const auto shared = shareAmongThreads(std::make_unique<Products>());
  EXPECT_NE(dynamic_cast<TeamSimulator*>(shared.get()), nullptr);
  const auto single = shareAmongThreads(std::make_unique<Products>(1));
  EXPECT_EQ(dynamic_cast<TeamSimulator*>(single.get()), nullptr);
}

}  // namespace
}  // namespace twinmap
