#pragma once

// A part of http_server.cpp, the one source that compiles Beast.

#include <algorithm>
#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cctype>
#include <set>
#include <sstream>

#include "framework/serve/http/http_handler.hpp"
#include "framework/serve/http/http_limits.hpp"
#include "framework/serve/http/problem.hpp"

namespace twinmap::serve {

namespace net = boost::asio;
namespace http = boost::beast::http;
using tcp = net::ip::tcp;
using boost::system::error_code;

class Connection;

/// What all connections share. All but the count belongs to the thread of HttpServer::run().
struct Connections {
  Connections(const HttpLimits& given, HttpHandler& handler_of_all)
      : limits(given), handler(handler_of_all) {}

  net::io_context context{1};
  const HttpLimits limits;
  HttpHandler& handler;
  std::set<Connection*> all{};
  std::size_t body_bytes = 0;  // of all requests under way
  int streams = 0;
  std::atomic<int> count{0};
  bool stops = false;
  net::executor_work_guard<net::io_context::executor_type> work{context.get_executor()};

  void remove(Connection* connection) {
    all.erase(connection);
    --count;
    endIfDone();
  }

  /// Lets the context run out of work.
  void endIfDone() {
    if (stops && all.empty()) {
      work.reset();
    }
  }
};

inline std::string toLower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

inline HttpRequest makeHead(const http::request<http::string_body>& message) {
  HttpRequest head{std::string(message.method_string()), std::string(message.target())};
  for (const auto& field : message) {
    std::string& value = head.fields[toLower(std::string(field.name_string()))];
    value += (value.empty() ? "" : ", ") + std::string(field.value());
  }
  return head;
}

/// The status that says what is wrong with a request; 0: it ended, and nobody waits for an answer.
inline int getStatus(const error_code& error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return 431;
  }
  if (error == http::error::body_limit) {
    return 413;
  }
  const bool ended = error == http::error::end_of_stream || error == http::error::partial_message;
  return ended || error.category() != http::make_error_code(http::error::bad_value).category() ? 0 : 400;
}

}  // namespace twinmap::serve
