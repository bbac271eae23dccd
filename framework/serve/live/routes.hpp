#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/serve/http/http_message.hpp"

namespace twinmap::serve {

/// A path that is served.
struct Route {
  std::string path;
  std::string method;              ///< GET, which HEAD is as well; or POST
  std::vector<std::string> query;  ///< keys that it takes
};

const std::vector<Route>& listRoutes();

/// Why a request fits none: 404, 405, 400 for its query, 415 for its body; none: it fits one.
std::optional<HttpResponse> refuseRoute(const HttpRequest& request);

/// "text/csv" of "Text/CSV; charset=utf-8".
std::string getMediaType(const HttpRequest& request);

}  // namespace twinmap::serve
