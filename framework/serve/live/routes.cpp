#include "framework/serve/live/routes.hpp"

#include <algorithm>
#include <cctype>

#include "framework/base/text/nearest_name.hpp"
#include "framework/serve/http/problem.hpp"
#include "framework/serve/live/request_target.hpp"

namespace twinmap::serve {
namespace {

bool takes(const Route& route, const std::string& method) {
  return method == route.method || (method == "HEAD" && route.method == "GET");
}

HttpResponse refuseMethod(const Route& route) {
  const std::string allowed = route.method == "GET" ? "GET, HEAD" : route.method;
  HttpResponse response = makeProblem(405, route.path + " takes " + allowed + " alone");
  response.fields.emplace_back("Allow", allowed);
  return response;
}

std::optional<HttpResponse> refuseQuery(const Route& route, const RequestTarget& target) {
  for (const auto& [key, value] : target.query) {
    if (std::find(route.query.begin(), route.query.end(), key) == route.query.end()) {
      return makeProblem(400, route.path + " has no '" + key + "'" + suggestName(key, route.query) +
                                  (route.query.empty() ? "" : "\n  it has: " + listNames(route.query)));
    }
  }
  return std::nullopt;
}

}  // namespace

const std::vector<Route>& listRoutes() {
  static const std::vector<Route> routes{{"/", "GET", {}},
                                         {"/chart.js", "GET", {}},
                                         {"/events", "GET", {}},
                                         {"/health", "GET", {}},
                                         {"/history", "GET", {"last"}},
                                         {"/live.css", "GET", {}},
                                         {"/live.js", "GET", {}},
                                         {"/measurements", "POST", {"at", "name", "trial"}},
                                         {"/metrics", "GET", {}},
                                         {"/openapi.json", "GET", {}},
                                         {"/page", "GET", {}},
                                         {"/state", "GET", {}}};
  return routes;
}

std::string getMediaType(const HttpRequest& request) {
  const std::string* field = request.findField("content-type");
  std::string type = field == nullptr ? "" : field->substr(0, field->find_first_of("; "));
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return std::tolower(c); });
  return type;
}

std::optional<HttpResponse> refuseRoute(const HttpRequest& request) {
  RequestTarget target;
  try {
    target = parseTarget(request.target);
  } catch (const BadTarget& error) {
    return makeProblem(400, error.what());
  }
  const auto& routes = listRoutes();
  const auto route =
      std::find_if(routes.begin(), routes.end(), [&](const Route& one) { return one.path == target.path; });
  if (route == routes.end()) {
    return makeProblem(404, "nothing is here; /openapi.json lists what there is");
  }
  if (!takes(*route, request.method)) {
    return refuseMethod(*route);
  }
  const std::string type = getMediaType(request);
  if (route->method == "POST" && type != "text/csv" && type != "application/json") {
    return makeProblem(415, "the Content-Type of a measurement is text/csv or application/json");
  }
  return refuseQuery(*route, target);
}

}  // namespace twinmap::serve
