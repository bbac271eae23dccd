#include "framework/serve/live/request_target.hpp"

#include <cctype>
#include <sstream>

namespace twinmap::serve {
namespace {

std::string decode(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    if (i + 2 >= text.size() || std::isxdigit(static_cast<unsigned char>(text[i + 1])) == 0 ||
        std::isxdigit(static_cast<unsigned char>(text[i + 2])) == 0) {
      throw BadTarget("'" + text + "': a % is followed by two hexadecimal digits");
    }
    decoded += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
    i += 2;
  }
  return decoded;
}

}  // namespace

RequestTarget parseTarget(const std::string& target) {
  if (target.empty() || target.front() != '/') {
    throw BadTarget("a request's target begins with /");
  }
  const std::size_t question = target.find('?');
  RequestTarget parsed{target.substr(0, question), {}};
  if (question == std::string::npos) {
    return parsed;
  }
  std::istringstream pairs(target.substr(question + 1));
  for (std::string pair; std::getline(pairs, pair, '&');) {
    const std::size_t equals = pair.find('=');
    const std::string key = decode(pair.substr(0, equals));
    const std::string value = equals == std::string::npos ? "" : decode(pair.substr(equals + 1));
    if (!parsed.query.emplace(key, value).second) {
      throw BadTarget("'" + key + "' stands twice");
    }
  }
  return parsed;
}

}  // namespace twinmap::serve
