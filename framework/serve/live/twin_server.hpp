#pragma once

#include <memory>
#include <optional>
#include <string>

#include "framework/serve/http/http_server.hpp"
#include "framework/serve/live/access.hpp"
#include "framework/serve/live/measurement_worker.hpp"
#include "framework/serve/live/metrics.hpp"
#include "framework/serve/live/request_target.hpp"

namespace twinmap::serve {

/// A twin over HTTP (docs/how-to/serve-a-twin.md, openapi.json).
class TwinServer final : private HttpHandler {
 public:
  /// Listens from here on. The service must outlive the server. version: of twinmap, in /metrics. Throws as
  /// HttpServer.
  TwinServer(MeasurementService& service, const ListenAddress& address, const HttpLimits& limits,
             Access access, const std::string& version);

  unsigned short getPort() const { return http_.getPort(); }

  /// Serves until stop(); what had come by then is answered. Throws std::runtime_error where the twin could
  /// not be written, which stops the server too.
  void run();
  /// From any thread.
  void stop() { http_.stop(); }
  /// For measurements that come otherwise.
  void submit(Read read, Answered answered) { worker_.submit(std::move(read), std::move(answered)); }

 private:
  std::optional<HttpResponse> refuse(const HttpRequest& head) override;
  void handle(HttpRequest request, Reply reply) override;
  void noteAnswer(int status) override { metrics_.noteRequest(status); }

  void takeMeasurement(HttpRequest request, const RequestTarget& target, const Reply& reply);
  void answerHistory(const RequestTarget& target, const Reply& reply);
  void answerPage(const Reply& reply);
  HttpResponse answerAtOnce(const std::string& path) const;
  HttpResponse describeHealth() const;
  HttpResponse describeMetrics() const;
  HttpResponse openStream() const;

  const Access access_;
  Metrics metrics_;
  HttpServer http_;
  MeasurementWorker worker_;
};

}  // namespace twinmap::serve
