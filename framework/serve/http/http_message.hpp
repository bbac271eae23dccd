#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace twinmap::serve {

/// What a client asks. Fields of one name are one, with ", " between their values.
struct HttpRequest {
  std::string method;                           ///< "POST"
  std::string target;                           ///< "/measurements?at=12", as it was sent
  std::map<std::string, std::string> fields{};  ///< by their names in lower case
  std::string body{};

  /// Null of none. name: in lower case.
  const std::string* findField(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? nullptr : &found->second;
  }
};

/// What it is answered.
struct HttpResponse {
  int status = 200;
  std::string type = "application/json";  ///< Content-Type
  std::string body{};
  std::vector<std::pair<std::string, std::string>> fields{};  ///< beside Content-Type and Content-Length
  bool streams = false;  ///< it has no end: the body is followed by what HttpServer::publish() is given
};

}  // namespace twinmap::serve
