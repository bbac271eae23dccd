#pragma once

#include <optional>
#include <string>

#include "framework/serve/http/http_message.hpp"

namespace twinmap::serve {

/// Who may ask.
struct Access {
  std::string token{};  ///< every request is to bring it; "": none is asked for, on loopback alone
};

/// Whether both are equal, in a time that depends on the length of `given` alone. `secret` is not empty.
bool equalsInConstantTime(const std::string& given, const std::string& secret);

/// Why a request may not be answered; none: it may.
/// - 401 without the token: "Authorization: Bearer TOKEN", or Basic with the token as the password, which a
///   browser asks its user for.
/// - 421 where none is asked for and the Host is not this machine's own: a page elsewhere whose name points
///   here (DNS rebinding) does not read the twin.
/// - 403 for a POST that a page of another origin has sent.
std::optional<HttpResponse> refuseAccess(const Access& access, const HttpRequest& request);

/// The first line of a file. Throws ExperimentError where it cannot be read, others than its owner and group
/// may read it, or it has fewer than 16 characters.
std::string readToken(const std::string& file);

}  // namespace twinmap::serve
