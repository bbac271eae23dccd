#pragma once

#include <string>

namespace twinmap::serve {

/// Where a server listens.
struct ListenAddress {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6, in digits
  unsigned short port = 8765;         ///< 0: the system chooses

  /// Whether only this machine reaches it: 127.0.0.0/8, ::1.
  bool isLoopback() const;
};

/// Reads "127.0.0.1:8765", "[::1]:8765", "localhost:8765" or ":8765" (this machine alone). Throws
/// ExperimentError, which names the option --listen, for anything else.
ListenAddress parseListenAddress(const std::string& text);

/// "http://127.0.0.1:8765".
std::string makeUrl(const ListenAddress& address);

}  // namespace twinmap::serve
