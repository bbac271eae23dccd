#pragma once

#include <chrono>
#include <cstddef>

namespace twinmap::serve {

/// What one client, and all of them together, may take.
struct HttpLimits {
  std::size_t body = std::size_t{64} << 20;     ///< bytes; 413 beyond
  std::size_t header = std::size_t{8} << 10;    ///< bytes of request line and fields; 431 beyond
  std::size_t bodies = std::size_t{128} << 20;  ///< bytes of all requests under way, two of the largest; 429
  int connections = 64;                         ///< 429 beyond
  int streams = 16;                             ///< of them, so that pages never keep measurements out; 429
  std::chrono::milliseconds request{10'000};    ///< to send one, from its first byte; 408 beyond
  std::chrono::milliseconds idle{60'000};       ///< between two requests; closed beyond
  std::chrono::milliseconds response{30'000};   ///< to take an answer; closed beyond
  /// For a client to read why its request was refused while it still sends: closed at once, TCP would drop
  /// it.
  std::chrono::milliseconds linger{2'000};
  /// Between signs of life on a stream that has nothing to say: proxies close what is silent for 60 s.
  std::chrono::milliseconds heartbeat{15'000};
};

}  // namespace twinmap::serve
