#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace twinmap::program {

/// Zeros that begin at a multiple of 64 bytes: a cache line, and the largest register. Movable, not copyable.
class AlignedBuffer {
 public:
  explicit AlignedBuffer(std::size_t size = 0) : memory_(size + kLine) {
    const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(memory_.data()) / sizeof(double);
    begin_ = memory_.data() + (kLine - address % kLine) % kLine;
  }
  AlignedBuffer(AlignedBuffer&&) = default;
  AlignedBuffer& operator=(AlignedBuffer&&) = default;

  double* get() { return begin_; }
  const double* get() const { return begin_; }

 private:
  static constexpr std::size_t kLine = 8;  // doubles
  std::vector<double> memory_;
  double* begin_;
};

}  // namespace twinmap::program
