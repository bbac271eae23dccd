#pragma once

#include <string>

#include "framework/serve/http/http_message.hpp"

namespace twinmap::serve {

/// "Not Found" of 404; "" of a status that the server never gives.
const char* getReason(int status);

/// An error as problem details (RFC 9457): {"type": "about:blank", "title": "Not Found", "status": 404,
/// "detail": ...}.
HttpResponse makeProblem(int status, const std::string& detail);

}  // namespace twinmap::serve
