#include "framework/serve/http/listen_address.hpp"

#include <arpa/inet.h>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap::serve {
namespace {

bool isAddress(int family, const std::string& text) {
  in6_addr ignored{};  // the larger of both
  return ::inet_pton(family, text.c_str(), &ignored) == 1;
}

[[noreturn]] void throwAddress(const std::string& text, const std::string& rule) {
  throw ExperimentError("--listen: '" + text + "' " + rule +
                        "\n  give ADDRESS:PORT, such as 127.0.0.1:8765, [::1]:8765 or 0.0.0.0:8765");
}

unsigned short parsePort(const std::string& whole, const std::string& text) {
  constexpr double kMost = 65535;
  double port = 0.0;
  if (!parseLiteral(text, port) || port < 0 || port > kMost || port != static_cast<int>(port)) {
    throwAddress(whole, "has no port from 0 to 65535 after its last colon");
  }
  return static_cast<unsigned short>(port);
}

}  // namespace

bool ListenAddress::isLoopback() const {
  in_addr parsed{};
  constexpr int kNetBits = 24;
  return address == "::1" || (::inet_pton(AF_INET, address.c_str(), &parsed) == 1 &&
                              ntohl(parsed.s_addr) >> kNetBits == IN_LOOPBACKNET);
}

ListenAddress parseListenAddress(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) {
    throwAddress(text, "has no port");
  }
  ListenAddress parsed;
  parsed.port = parsePort(text, text.substr(colon + 1));
  std::string host = text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
    if (!isAddress(AF_INET6, host)) {
      throwAddress(text, "has not an IPv6 address between its brackets");
    }
  } else if (host.empty() || host == "localhost") {
    return parsed;
  } else if (!isAddress(AF_INET, host)) {
    throwAddress(
        text,
        "does not begin with an IPv4 address; names are not looked up, and IPv6 stands between brackets");
  }
  parsed.address = host;
  return parsed;
}

std::string makeUrl(const ListenAddress& address) {
  const bool is_v6 = address.address.find(':') != std::string::npos;
  return "http://" + (is_v6 ? "[" + address.address + "]" : address.address) + ":" +
         std::to_string(address.port);
}

}  // namespace twinmap::serve
