#include "framework/experiment/network_size.hpp"

namespace twinmap {
namespace {

struct Numbers {
  int units, steps, batch;
  double learning_rate;
};

Numbers getNumbers(NetworkSize size) {
  switch (size) {
    case NetworkSize::kSmall:
      return {64, 8000, 256, 0.002};
    case NetworkSize::kMedium:
      return {64, 18000, 1024, 0.004};
    default:
      return {192, 18000, 1024, 0.004};
  }
}

}  // namespace

NetworkSize chooseSize(int simulations) {
  if (simulations < NetworkMapSpec::kMany) {
    return NetworkSize::kSmall;
  }
  return simulations < NetworkMapSpec::kVeryMany ? NetworkSize::kMedium : NetworkSize::kLarge;
}

bool hasSize(const NetworkMapSpec& spec) {
  return spec.hidden || spec.steps || spec.batch || spec.learning_rate;
}

NetworkMapSpec completeSize(NetworkMapSpec spec, NetworkSize size) {
  const Numbers numbers = getNumbers(size);
  if (!spec.hidden) {
    spec.hidden = spec.bayesian == NetworkBayes::kHamiltonian
                      ? std::vector<int>{8}
                      : std::vector<int>{numbers.units, numbers.units};
  }
  spec.steps = spec.steps.value_or(numbers.steps);
  spec.batch = spec.batch.value_or(numbers.batch);
  spec.learning_rate = spec.learning_rate.value_or(numbers.learning_rate);
  return spec;
}

}  // namespace twinmap
