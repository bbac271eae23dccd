#include "framework/serve/http/http_server.hpp"

#include <stdexcept>

#include "framework/serve/http/connection.hpp"

namespace twinmap::serve {

/// The connections, and how they come.
class HttpServer::Implementation : public Connections, public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(const ListenAddress& address, const HttpLimits& given, HttpHandler& handler_of_all);

  unsigned short getPort() const { return port_; }
  void accept();
  void stop();
  void publish(const std::shared_ptr<const std::string>& text);

 private:
  tcp::acceptor acceptor_{context};
  unsigned short port_ = 0;
  net::steady_timer again_{context};
};

HttpServer::Implementation::Implementation(const ListenAddress& address, const HttpLimits& given,
                                           HttpHandler& handler_of_all)
    : Connections(given, handler_of_all) {
  try {
    const tcp::endpoint endpoint(net::ip::make_address(address.address), address.port);
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen();
    port_ = acceptor_.local_endpoint().port();
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(makeUrl(address) + ": cannot be listened at: " + error.code().message());
  }
}

void HttpServer::Implementation::accept() {
  static constexpr std::chrono::milliseconds kAcceptAgain{
      100};  // where the process has no file descriptor left
  acceptor_.async_accept([self = shared_from_this()](const error_code& error, tcp::socket socket) {
    if (self->stops) {
      return;
    }
    if (error) {
      self->again_.expires_after(kAcceptAgain);
      self->again_.async_wait([self](const error_code& cancelled) { cancelled ? void() : self->accept(); });
      return;
    }
    std::make_shared<Connection>(self, std::move(socket))->start();
    self->accept();
  });
}

void HttpServer::Implementation::stop() {
  stops = true;
  again_.cancel();
  error_code ignored;
  acceptor_.close(ignored);
  for (Connection* connection : std::vector<Connection*>(all.begin(), all.end())) {
    connection->closeIfIdle();
  }
  endIfDone();
}

void HttpServer::Implementation::publish(const std::shared_ptr<const std::string>& text) {
  for (Connection* connection : all) {
    connection->offer(text);
  }
}

HttpServer::HttpServer(const ListenAddress& address, const HttpLimits& limits, HttpHandler& handler)
    : implementation_(std::make_shared<Implementation>(address, limits, handler)) {}

HttpServer::~HttpServer() = default;

unsigned short HttpServer::getPort() const {
  return implementation_->getPort();
}

void HttpServer::run() {
  implementation_->accept();
  implementation_->context.run();
}

void HttpServer::stop() {
  net::post(implementation_->context, [this] { implementation_->stop(); });
}

void HttpServer::publish(std::string text) {
  net::post(implementation_->context, [this, shared = std::make_shared<const std::string>(std::move(text))] {
    implementation_->publish(shared);
  });
}

int HttpServer::countConnections() const {
  return implementation_->count;
}

}  // namespace twinmap::serve
