#include "framework/serve/live/access.hpp"

#include <sys/stat.h>

#include <array>
#include <vector>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/base64.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/serve/http/listen_address.hpp"
#include "framework/serve/http/problem.hpp"

namespace twinmap::serve {
namespace {

/// Guessed at a million a second, 16 letters last longer than any machine.
constexpr std::size_t kShortestToken = 16;

bool begins(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/// "twin:TOKEN" in letters, as a browser sends it; whatever the user's name is, the token is compared.
bool isBasic(const std::string& letters, const std::string& token) {
  const std::string decoded = decodeBase64(letters);
  const std::size_t colon = decoded.find(':');
  return colon != std::string::npos && equalsInConstantTime(decoded.substr(colon + 1), token);
}

bool bringsToken(const HttpRequest& request, const std::string& token) {
  const std::string* field = request.findField("authorization");
  const std::string bearer = "Bearer ", basic = "Basic ";
  if (field == nullptr) {
    return false;
  }
  return begins(*field, bearer)  ? equalsInConstantTime(field->substr(bearer.size()), token)
         : begins(*field, basic) ? isBasic(field->substr(basic.size()), token)
                                 : false;
}

/// "localhost" of "localhost:8765", "::1" of "[::1]".
std::string getHostName(const std::string& host) {
  if (!host.empty() && host.front() == '[') {
    return host.substr(1, host.find(']') - 1);
  }
  return host.substr(0, host.find(':'));
}

bool isThisMachine(const std::string& host) {
  const std::string name = getHostName(host);
  return name == "localhost" || ListenAddress{name, 0}.isLoopback();
}

bool isOfOrigin(const std::string& origin, const std::string& host) {
  return origin == "http://" + host || origin == "https://" + host;
}

}  // namespace

bool equalsInConstantTime(const std::string& given, const std::string& secret) {
  volatile unsigned char differs = given.size() == secret.size() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i) {
    differs = static_cast<unsigned char>(differs | (given[i] ^ secret[i % secret.size()]));
  }
  return differs == 0;
}

std::optional<HttpResponse> refuseAccess(const Access& access, const HttpRequest& request) {
  const std::string* host = request.findField("host");
  const std::string* origin = request.findField("origin");
  if (!access.token.empty() && !bringsToken(request, access.token)) {
    HttpResponse response =
        makeProblem(401, "the token is missing or another\n  send 'Authorization: Bearer TOKEN'");
    response.fields.emplace_back("WWW-Authenticate", "Bearer realm=\"twinmap\", Basic realm=\"twinmap\"");
    return response;
  }
  if (access.token.empty() && (host == nullptr || !isThisMachine(*host))) {
    return makeProblem(421, "without a token the Host is localhost, 127.0.0.1 or [::1]");
  }
  if (request.method == "POST" && origin != nullptr && !isOfOrigin(*origin, *host)) {
    return makeProblem(403, "a page of another origin may not write");
  }
  return std::nullopt;
}

std::string readToken(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0 && (status.st_mode & (S_IROTH | S_IWOTH)) != 0) {
    throw ExperimentError("--token-file: " + file + " can be read or written by all users\n  chmod 640 " +
                          file);
  }
  std::string text;
  try {
    text = readBytes(file);
  } catch (const std::exception& error) {
    throw ExperimentError("--token-file: " + std::string(error.what()));
  }
  const std::string token = text.substr(0, text.find_first_of("\r\n"));
  if (token.size() < kShortestToken) {
    throw ExperimentError("--token-file: " + file + " has fewer than 16 characters in its first line" +
                          "\n  make one: openssl rand -hex 32 > " + file);
  }
  return token;
}

}  // namespace twinmap::serve
