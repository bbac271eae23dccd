#pragma once

#include <cmath>

namespace twinmap::tracking {

/// The logarithm of a product of positive factors, by one logarithm: those of each took a fifth of an update.
class LogProduct {
 public:
  void multiply(double factor) {
    constexpr double kLarge = 1e150;
    product_ *= factor;
    if (!(product_ < kLarge && product_ > 1.0 / kLarge)) {
      sum_ += std::log(product_);
      product_ = 1.0;
    }
  }
  double calc() const { return sum_ + std::log(product_); }

 private:
  double product_ = 1.0, sum_ = 0.0;
};

}  // namespace twinmap::tracking
