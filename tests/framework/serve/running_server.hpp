#pragma once

#include <future>

#include "framework/serve/live/twin_server.hpp"
#include "tests/framework/serve/fake_service.hpp"
#include "tests/framework/serve/raw_client.hpp"

namespace twinmap::serve {

/// A server of a fake twin on a port of its own, in a thread of its own.
class RunningServer {
 public:
  explicit RunningServer(const HttpLimits& limits = {}, const Access& access = {})
      : server_(service, ListenAddress{"127.0.0.1", 0}, limits, access, "1.2.3"),
        running_(std::async(std::launch::async, [this] { server_.run(); })) {}
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;
  ~RunningServer() {
    server_.stop();
    if (running_.valid()) {
      running_.wait();
    }
  }

  unsigned short getPort() const { return port_; }
  RawResponse ask(const std::string& request) const { return RawClient(port_).ask(request); }
  void stop() { server_.stop(); }
  /// As run().
  void finish() { running_.get(); }

  FakeService service;

 private:
  TwinServer server_;
  const unsigned short port_ = server_.getPort();
  std::future<void> running_;
};

}  // namespace twinmap::serve
