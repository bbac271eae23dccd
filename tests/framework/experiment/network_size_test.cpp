#include "framework/experiment/network_size.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

TEST(NetworkSize, GrowsWithTheSimulations) {
  EXPECT_EQ(chooseSize(100), NetworkSize::kSmall);
  EXPECT_EQ(chooseSize(2000), NetworkSize::kSmall);
  EXPECT_EQ(chooseSize(2001), NetworkSize::kMedium);
  EXPECT_EQ(chooseSize(19999), NetworkSize::kMedium);
  EXPECT_EQ(chooseSize(20000), NetworkSize::kLarge);
}

TEST(NetworkSize, LeavesWhatIsGiven) {
  NetworkMapSpec given;
  EXPECT_FALSE(hasSize(given));
  given.steps = 500;
  EXPECT_TRUE(hasSize(given));
  const NetworkMapSpec large = completeSize(given, NetworkSize::kLarge);
  EXPECT_EQ(large.steps, 500);
  EXPECT_EQ(large.hidden, (std::vector<int>{192, 192}));
  EXPECT_EQ(large.batch, 1024);
  EXPECT_EQ(large.learning_rate, 0.004);
}

TEST(NetworkSize, OfSampledWeightsIsSmall) {
  NetworkMapSpec sampled;
  sampled.bayesian = NetworkBayes::kHamiltonian;
  EXPECT_EQ(completeSize(sampled, NetworkSize::kSmall).hidden, std::vector<int>{8});
}

}  // namespace
}  // namespace twinmap
