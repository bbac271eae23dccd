#include "framework/serve/http/problem.hpp"

#include <map>

#include "framework/base/json/json.hpp"

namespace twinmap::serve {

const char* getReason(int status) {
  static const std::map<int, const char*> reasons{{200, "OK"},
                                                  {400, "Bad Request"},
                                                  {401, "Unauthorized"},
                                                  {403, "Forbidden"},
                                                  {404, "Not Found"},
                                                  {405, "Method Not Allowed"},
                                                  {408, "Request Timeout"},
                                                  {413, "Content Too Large"},
                                                  {415, "Unsupported Media Type"},
                                                  {421, "Misdirected Request"},
                                                  {422, "Unprocessable Content"},
                                                  {429, "Too Many Requests"},
                                                  {431, "Request Header Fields Too Large"},
                                                  {500, "Internal Server Error"},
                                                  {503, "Service Unavailable"}};
  const auto found = reasons.find(status);
  return found == reasons.end() ? "" : found->second;
}

HttpResponse makeProblem(int status, const std::string& detail) {
  const Json problem{
      {"type", "about:blank"}, {"title", getReason(status)}, {"status", status}, {"detail", detail}};
  HttpResponse response{status, "application/problem+json", formatJson(problem) + "\n"};
  if (status == 429) {
    response.fields.emplace_back("Retry-After", "1");
  }
  return response;
}

}  // namespace twinmap::serve
