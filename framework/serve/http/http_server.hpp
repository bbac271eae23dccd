#pragma once

#include <memory>
#include <string>

#include "framework/serve/http/http_handler.hpp"
#include "framework/serve/http/http_limits.hpp"
#include "framework/serve/http/listen_address.hpp"

namespace twinmap::serve {

/// HTTP/1.1 by one thread: keep-alive, pipelining, chunked bodies, "Expect: 100-continue", and streams of
/// events. Requests of one connection are answered one after another. What is not HTTP or beyond the limits
/// is answered by problem details (makeProblem) and its connection closed.
///
/// Memory: `bodies` and, of each connection, 72 kB.
class HttpServer {
 public:
  /// Listens from here on. Throws std::runtime_error where the address cannot be had. The handler must
  /// outlive the server.
  HttpServer(const ListenAddress& address, const HttpLimits& limits, HttpHandler& handler);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  ~HttpServer();

  /// That is listened at: the system's choice where 0 was asked for.
  unsigned short getPort() const;

  /// Serves until stop() was called and every request that had begun by then has its answer.
  void run();

  /// No connection is accepted and no request begun from now on. From any thread.
  void stop();

  /// Writes a text to all streams. One that is still taking an earlier text gets the newest of what comes
  /// meanwhile. From any thread.
  void publish(std::string text);

  /// From any thread.
  int countConnections() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace twinmap::serve
