#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "framework/base/json/json_fwd.hpp"

namespace twinmap::serve {

/// What a monitoring system reads of the server, as Prometheus' text. From any thread.
class Metrics {
 public:
  /// version: of twinmap.
  explicit Metrics(std::string version) : version_(std::move(version)) {}

  void noteRequest(int status);
  /// status: of the answer, "ok", or "error"; seconds: that inference and update took.
  void noteMeasurement(const std::string& status, double seconds);
  void noteCommit();
  /// Takes the "parameters", "measurements" and "alarms" that the belief has.
  void setState(const Json& state);

  /// Text format 0.0.4. waiting: measurements; connections: that are open.
  std::string format(std::size_t waiting, int connections) const;

 private:
  /// From what a network takes to what a chaotic machine takes; s.
  static constexpr std::array<double, 9> kBounds{1e-4, 1e-3, 5e-3, 0.02, 0.1, 0.5, 2, 10, 60};

  struct Parameter {
    double mean = 0.0, stddev = 0.0;
  };

  const std::string version_;
  mutable std::mutex mutex_;  // of what follows
  std::map<int, std::uint64_t> requests_;
  std::map<std::string, std::uint64_t> measurements_;
  std::array<std::uint64_t, kBounds.size() + 1> durations_{};  // the last: beyond all bounds
  double seconds_ = 0.0;
  std::uint64_t commits_ = 0;
  std::map<std::string, Parameter> parameters_;
  std::uint64_t in_belief_ = 0, alarms_ = 0;
};

}  // namespace twinmap::serve
