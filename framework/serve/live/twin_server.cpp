#include "framework/serve/live/twin_server.hpp"

#include <cmath>
#include <stdexcept>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/serve/http/problem.hpp"
#include "framework/serve/live/page_files.hpp"
#include "framework/serve/live/posted_measurement.hpp"
#include "framework/serve/live/routes.hpp"

namespace twinmap::serve {
namespace {

/// A page draws no more than its width; a table of as many parameters has some megabytes.
constexpr double kMostHistory = 100000, kUsualHistory = 2000;

/// Of a page without scripts, whose styles stand within it.
constexpr const char* kPolicyOfPictures =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; base-uri 'none'; "
    "form-action 'none'";

std::string makeEvent(const std::string& data) {
  return "event: belief\ndata: " + data + "\n\n";
}

HttpResponse makeFile(const char* type, std::string_view body) {
  return {200, type, std::string(body)};
}

/// Which scripts and connections the page may have: its own.
HttpResponse makeLivePage() {
  HttpResponse response = makeFile("text/html; charset=utf-8", getLivePage());
  response.fields.emplace_back("Content-Security-Policy",
                               "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
                               "img-src data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
  return response;
}

HttpResponse toResponse(Outcome outcome, const char* type) {
  switch (outcome.kind) {
    case Outcome::kAnswered:
      return {200, type, std::move(outcome.text)};
    case Outcome::kRefused:
      return makeProblem(422, outcome.text);
    case Outcome::kUnread:
      return makeProblem(400, outcome.text);
    default:
      return makeProblem(500, outcome.text);
  }
}

/// What a browser may do with an answer, whatever it is.
HttpResponse protect(HttpResponse response) {
  response.fields.emplace_back("Cache-Control", "no-store");
  response.fields.emplace_back("X-Content-Type-Options", "nosniff");
  response.fields.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
  response.fields.emplace_back("Referrer-Policy", "no-referrer");
  return response;
}

PostedMeasurement readPosted(const HttpRequest& request) {
  if (getMediaType(request) == "application/json") {
    return readPostedJson(request.body);
  }
  PostedMeasurement posted;
  posted.text = request.body;
  return posted;
}

/// What the query says, which the body may not say as well.
void readQuery(const std::map<std::string, std::string>& query, PostedMeasurement& posted) {
  for (const auto& [key, value] : query) {
    std::string& said = key == "at" ? posted.at : key == "trial" ? posted.trial : posted.name;
    if (!said.empty()) {
      throw ExperimentError("both the body and the query have '" + key + "'\n  leave one out");
    }
    said = value;
  }
}

/// 0 of what cannot be read.
std::size_t readLast(const RequestTarget& target) {
  const auto found = target.query.find("last");
  double last = kUsualHistory;
  if (found != target.query.end() &&
      (!parseLiteral(found->second, last) || last != std::floor(last) || last < 1 || last > kMostHistory)) {
    return 0;
  }
  return static_cast<std::size_t>(last);
}

}  // namespace

TwinServer::TwinServer(MeasurementService& service, const ListenAddress& address, const HttpLimits& limits,
                       Access access, const std::string& version)
    : access_(std::move(access)),
      metrics_(version),
      http_(address, limits, *this),
      worker_(
          service, metrics_, [this](const std::string& event) { http_.publish(makeEvent(event)); },
          [this] { http_.stop(); }) {}

void TwinServer::run() {
  http_.run();
  worker_.finish();
  if (const std::string failure = worker_.getFailure(); !failure.empty()) {
    throw std::runtime_error("the twin could not be written: " + failure);
  }
}

std::optional<HttpResponse> TwinServer::refuse(const HttpRequest& head) {
  std::optional<HttpResponse> refused = refuseAccess(access_, head);
  if (!refused) {
    refused = refuseRoute(head);
  }
  return refused ? std::optional<HttpResponse>(protect(std::move(*refused))) : std::nullopt;
}

void TwinServer::handle(HttpRequest request, Reply reply) {
  const RequestTarget target = parseTarget(request.target);
  const Reply answer = [reply = std::move(reply)](HttpResponse response) {
    reply(protect(std::move(response)));
  };
  if (target.path == "/measurements") {
    takeMeasurement(std::move(request), target, answer);
  } else if (target.path == "/history") {
    answerHistory(target, answer);
  } else if (target.path == "/page") {
    answerPage(answer);
  } else {
    answer(answerAtOnce(target.path));
  }
}

void TwinServer::answerHistory(const RequestTarget& target, const Reply& reply) {
  const std::size_t last = readLast(target);
  if (last == 0) {
    reply(makeProblem(400, "'last' is a whole number from 1 to 100000"));
    return;
  }
  worker_.ask([last](const MeasurementService& service) { return service.makeHistory(last); },
              [reply](Outcome outcome) { reply(toResponse(std::move(outcome), "text/csv; charset=utf-8")); });
}

void TwinServer::answerPage(const Reply& reply) {
  worker_.ask([](const MeasurementService& service) { return service.makePage(); },
              [reply](Outcome outcome) {
                HttpResponse response = toResponse(std::move(outcome), "text/html; charset=utf-8");
                response.fields.emplace_back("Content-Security-Policy", kPolicyOfPictures);
                reply(std::move(response));
              });
}

HttpResponse TwinServer::answerAtOnce(const std::string& path) const {
  const char* script = "text/javascript; charset=utf-8";
  return path == "/state"      ? HttpResponse{200, "application/json", *worker_.getState() + "\n"}
         : path == "/health"   ? describeHealth()
         : path == "/metrics"  ? describeMetrics()
         : path == "/events"   ? openStream()
         : path == "/live.css" ? makeFile("text/css; charset=utf-8", getLiveStyle())
         : path == "/live.js"  ? makeFile(script, getLiveScript())
         : path == "/chart.js" ? makeFile(script, getChartScript())
         : path == "/"         ? makeLivePage()
                               : makeFile("application/json", getOpenApi());
}

HttpResponse TwinServer::describeMetrics() const {
  return {200, "text/plain; version=0.0.4; charset=utf-8",
          metrics_.format(worker_.countWaiting(), http_.countConnections())};
}

void TwinServer::takeMeasurement(HttpRequest request, const RequestTarget& target, const Reply& reply) {
  worker_.submit(
      [request = std::move(request), target] {
        PostedMeasurement posted = readPosted(request);
        readQuery(target.query, posted);
        return posted;
      },
      [reply](Outcome outcome) { reply(toResponse(std::move(outcome), "application/json")); });
}

HttpResponse TwinServer::describeHealth() const {
  if (const std::string failure = worker_.getFailure(); !failure.empty()) {
    return makeProblem(503, "the twin could not be written: " + failure);
  }
  return {200, "application/json",
          formatJson(Json{{"status", "ok"}, {"waiting", worker_.countWaiting()}}) + "\n"};
}

/// Begins with the belief as it is.
HttpResponse TwinServer::openStream() const {
  HttpResponse response{200, "text/event-stream", makeEvent("{\"state\": " + *worker_.getState() + "}")};
  response.streams = true;
  return response;
}

}  // namespace twinmap::serve
