#pragma once

#include <functional>
#include <optional>

#include "framework/serve/http/http_message.hpp"

namespace twinmap::serve {

/// To be called once, from any thread.
using Reply = std::function<void(HttpResponse)>;

/// What answers the requests of a server. All is called by the thread of HttpServer::run().
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;

  /// An answer to a request whose body was not read yet and will not be; none: it is to be read.
  virtual std::optional<HttpResponse> refuse(const HttpRequest& head) = 0;
  /// Answers a whole request, now or later.
  virtual void handle(HttpRequest request, Reply reply) = 0;
  /// After each answer, those to requests included that are not HTTP.
  virtual void noteAnswer(int status) = 0;
};

}  // namespace twinmap::serve
