#pragma once

// A part of http_server.cpp, the one source that compiles Beast.

#include "framework/serve/http/connections.hpp"

namespace twinmap::serve {

constexpr std::size_t kReadSize = std::size_t{64} << 10;  // what Beast reads at a time
/// What is complete already cannot be cancelled: the next operation of those that follow each other is.
constexpr std::chrono::milliseconds kCancelAgain{20};

/// One client. Lives as long as an operation of it is under way, or its reply is awaited.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(std::shared_ptr<Connections> server, tcp::socket socket)
      : server_(std::move(server)), socket_(std::move(socket)), timer_(server_->context) {
    server_->all.insert(this);
    ++server_->count;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() {
    releaseBody();
    server_->streams -= streams_ ? 1 : 0;
    server_->remove(this);
  }

  void start() {
    error_code ignored;
    socket_.set_option(tcp::no_delay(true), ignored);
    beginRequest();
    if (server_->count > limits().connections) {
      refuse(429, "all " + std::to_string(limits().connections) + " connections are in use; try again");
      return;
    }
    awaitRequest();
  }

  /// What has not begun a request, and streams, which would never end.
  void closeIfIdle() {
    if (idles_ || streams_) {
      close();
    }
  }

  void offer(const std::shared_ptr<const std::string>& text) {
    if (streams_) {
      offered_ = text;
      writeOffered();
    }
  }

 private:
  const HttpLimits& limits() const { return server_->limits; }

  /// A handler that keeps the connection alive.
  template <class Member>
  auto bind(Member member) {
    return [self = shared_from_this(), member](const error_code& error, auto&&...) {
      (self.get()->*member)(error);
    };
  }

  /// What is under way ends with operation_aborted by then, or timed_out_ is set.
  void setDeadline(std::chrono::milliseconds time) {
    timed_out_ = false;
    awaitDeadline(time);
  }

  void awaitDeadline(std::chrono::milliseconds time) {
    timer_.expires_after(time);
    timer_.async_wait([weak = weak_from_this()](const error_code& error) {
      const std::shared_ptr<Connection> self = weak.lock();
      if (!error && self && self->timer_.expiry() <= std::chrono::steady_clock::now()) {
        self->timed_out_ = true;
        error_code ignored;
        self->socket_.cancel(ignored);
        self->awaitDeadline(kCancelAgain);
      }
    });
  }

  void close() {
    timer_.cancel();
    error_code ignored;
    socket_.close(ignored);
  }

  void releaseBody() {
    server_->body_bytes -= body_bytes_;
    body_bytes_ = 0;
  }

  void beginRequest() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(limits().header));
    parser_->body_limit(limits().body);
    closes_ = false;
  }

  void awaitRequest() {
    beginRequest();
    if (server_->stops) {
      close();
      return;
    }
    if (buffer_.size() > 0) {  // pipelined
      readHeader({});
      return;
    }
    idles_ = true;
    setDeadline(limits().idle);
    socket_.async_wait(tcp::socket::wait_read, bind(&Connection::readHeader));
  }

  void readHeader(const error_code& error) {
    idles_ = false;
    if (error) {
      close();
      return;
    }
    setDeadline(limits().request);
    http::async_read_header(socket_, buffer_, *parser_, bind(&Connection::takeHeader));
  }

  void takeHeader(const error_code& error) {
    if (error) {
      fail(error);
      return;
    }
    const auto& message = parser_->get();
    if (message.count(http::field::host) != 1) {
      refuse(400, "a request has one Host field");
    } else if (message.count(http::field::transfer_encoding) > 0 &&
               toLower(std::string(message[http::field::transfer_encoding])) != "chunked") {
      refuse(400, "Transfer-Encoding can be 'chunked' alone");
    } else if (std::optional<HttpResponse> refused = server_->handler.refuse(makeHead(message))) {
      closes_ = !parser_->is_done();
      respond(std::move(*refused));
    } else if (toLower(std::string(message[http::field::expect])) == "100-continue" && !parser_->is_done()) {
      static constexpr char kContinue[] = "HTTP/1.1 100 Continue\r\n\r\n";
      net::async_write(socket_, net::buffer(kContinue, sizeof(kContinue) - 1), bind(&Connection::readBody));
    } else {
      readBody({});
    }
  }

  /// Counts what the body takes, or what the client says that it will.
  bool reserveBody() {
    const std::size_t bytes =
        std::max<std::size_t>(parser_->content_length().value_or(0), parser_->get().body().size());
    server_->body_bytes += bytes - body_bytes_;
    body_bytes_ = bytes;
    return server_->body_bytes <= limits().bodies;
  }

  void readBody(const error_code& error) {
    if (error || timed_out_) {
      fail(error);
    } else if (!reserveBody()) {
      refuse(429, "the requests under way have " + std::to_string(limits().bodies >> 20) + " MiB; try again");
    } else if (parser_->is_done()) {
      handle();
    } else {
      http::async_read_some(socket_, buffer_, *parser_, bind(&Connection::readBody));
    }
  }

  void handle() {
    timer_.cancel();
    HttpRequest request = makeHead(parser_->get());
    request.body = std::move(parser_->get().body());
    server_->handler.handle(std::move(request), [self = shared_from_this()](HttpResponse response) mutable {
      net::io_context& context = self->server_->context;  // whose thread alone may end the connection
      net::post(context, [self = std::move(self), response = std::move(response)]() mutable {
        self->respond(std::move(response));
      });
    });
  }

  void fail(const error_code& error) {
    if (timed_out_ && (parser_->got_some() || buffer_.size() > 0)) {
      refuse(408, "a request is sent within " + std::to_string(limits().request.count()) + " ms");
    } else if (const int status = getStatus(error)) {
      refuse(status, status == 431 ? "request line and fields have at most " +
                                         std::to_string(limits().header) + " bytes"
                     : status == 413 ? "a body has at most " + std::to_string(limits().body) + " bytes"
                                     : "no HTTP/1.1: " + error.message());
    } else {
      close();
    }
  }

  void refuse(int status, const std::string& detail) {
    closes_ = true;
    respond(makeProblem(status, detail));
  }

  void respond(HttpResponse response) {
    const bool is_head = parser_->get().method() == http::verb::head;
    response.streams = response.streams && !is_head;
    if (response.streams && server_->streams >= limits().streams) {
      response =
          makeProblem(429, "all " + std::to_string(limits().streams) + " streams are in use; try again");
    }
    server_->handler.noteAnswer(response.status);
    closes_ = closes_ || server_->stops || !parser_->get().keep_alive() || response.streams;
    message_ = {static_cast<http::status>(response.status), 11};
    message_.reason(getReason(response.status));
    message_.set(http::field::content_type, response.type);
    for (const auto& [name, value] : response.fields) {
      message_.set(name, value);
    }
    if (response.streams) {
      message_.set(http::field::connection, "close");
      stream(std::move(response.body));
      return;
    }
    message_.keep_alive(!closes_);
    message_.content_length(response.body.size());
    message_.body() = is_head ? "" : std::move(response.body);
    setDeadline(limits().response);
    http::async_write(socket_, message_, bind(&Connection::finishAnswer));
  }

  void finishAnswer(const error_code& error) {
    message_.body().clear();
    message_.body().shrink_to_fit();
    releaseBody();
    if (error) {
      close();
    } else if (closes_) {
      error_code ignored;
      socket_.shutdown(tcp::socket::shutdown_send, ignored);
      setDeadline(limits().linger);
      discard({});
    } else {
      awaitRequest();
    }
  }

  /// Reads on until the client closes.
  void discard(const error_code& error) {
    if (error || timed_out_) {
      close();
      return;
    }
    buffer_.clear();
    socket_.async_read_some(buffer_.prepare(kReadSize), bind(&Connection::discard));
  }

  void stream(std::string first) {
    streams_ = true;
    ++server_->streams;
    releaseBody();
    std::ostringstream head;
    head << message_.base();
    offered_ = std::make_shared<const std::string>(head.str() + first);
    discard({});  // until the client closes
    writeOffered();
  }

  void writeOffered() {
    if (offered_ == nullptr || written_ != nullptr || !socket_.is_open()) {
      return;
    }
    written_ = std::exchange(offered_, nullptr);
    setDeadline(limits().response);
    net::async_write(socket_, net::buffer(*written_),
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       self->written_ = nullptr;
                       error ? self->close() : self->awaitOffer();
                     });
  }

  void awaitOffer() {
    timer_.expires_after(limits().heartbeat);
    timer_.async_wait([weak = weak_from_this()](const error_code& error) {
      const std::shared_ptr<Connection> self = weak.lock();
      if (!error && self) {
        self->offer(std::make_shared<const std::string>(": \n\n"));
      }
    });
    writeOffered();
  }

  const std::shared_ptr<Connections> server_;
  tcp::socket socket_;
  net::steady_timer timer_;
  boost::beast::flat_buffer buffer_{kReadSize + (std::size_t{8} << 10)};
  std::optional<http::request_parser<http::string_body>> parser_;  // of the request under way
  http::response<http::string_body> message_;
  std::shared_ptr<const std::string> offered_, written_;  // of a stream
  std::size_t body_bytes_ = 0;
  bool idles_ = false, closes_ = false, streams_ = false, timed_out_ = false;
};

}  // namespace twinmap::serve
