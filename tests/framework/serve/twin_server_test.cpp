#include <gtest/gtest.h>

#include <set>
#include <thread>
#include <vector>

#include "framework/serve/live/page_files.hpp"
#include "framework/serve/live/routes.hpp"
#include "tests/framework/serve/running_server.hpp"

using namespace twinmap;
using namespace twinmap::serve;

namespace {

constexpr const char* kToken = "0123456789abcdef-token";

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(TwinServer, AnswersMeasurementsAsCsvAndJson) {
  RunningServer server;
  const RawResponse csv = server.ask(makePost("t,x\n0,1\n", "/measurements?at=12&trial=fast&name=a%20b.csv"));
  EXPECT_EQ(csv.status, 200);
  EXPECT_TRUE(csv.has("Content-Type: application/json"));
  const Json answer = parseJson(csv.body);
  EXPECT_EQ(answer["at"], "12");
  EXPECT_EQ(answer["trial"], "fast");
  EXPECT_EQ(answer["source"], "a b.csv");
  EXPECT_EQ(answer["text"], "t,x\n0,1\n");
  const RawResponse json = server.ask(
      makePost(R"({"columns": {"t": [0], "x": [0.1]}, "at": 12})", "/measurements", "application/json"));
  EXPECT_EQ(parseJson(json.body)["text"], "t,x\n0,0.1\n");
  EXPECT_EQ(parseJson(json.body)["at"], "12");
}

TEST(TwinServer, SaysWhatIsWrongWithARequest) {
  RunningServer server;
  const std::string csv = "text/csv", json = "application/json";
  const struct {
    std::string request;
    int status;
    std::string says;
  } cases[] = {{makeGet("/nowhere"), 404, "/openapi.json"},
               {makeGet("/../../etc/passwd"), 404, "nothing is here"},
               {makeGet("/%73tate"), 404, "nothing is here"},
               {makeGet("http://localhost/state"), 400, "begins with /"},
               {makeGet("/measurements"), 405, "takes POST alone"},
               {makePost("a", "/state"), 405, "takes GET, HEAD alone"},
               {makePost("a", "/measurements", "text/plain"), 415, "text/csv or application/json"},
               {makePost("a", "/measurements?att=1"), 400, "did you mean 'at'?"},
               {makePost("a", "/measurements?at=1&at=2"), 400, "'at' stands twice"},
               {makePost("a", "/measurements?at=%zz"), 400, "two hexadecimal digits"},
               {makeGet("/history?last=0"), 400, "whole number"},
               {makeGet("/history?last=1e9"), 400, "whole number"},
               {makePost("{", "/measurements", json), 400, "cannot be read as JSON"},
               {makePost("[]", "/measurements", json), 422, "'columns' is missing"},
               {makePost(R"({"columns": {"t": [1]}, "at": 1})", "/measurements?at=1", json), 422,
                "both the body and the query"},
               {makePost("bad", "/measurements?name=x.csv"), 422, "x.csv:1: 'bad' must be a number"},
               {makePost("broken"), 500, "the simulator broke"}};
  for (const auto& one : cases) {
    const RawResponse response = server.ask(one.request);
    EXPECT_EQ(response.status, one.status) << one.request;
    EXPECT_TRUE(response.has("Content-Type: application/problem+json")) << one.request;
    EXPECT_TRUE(says(parseJson(response.body)["detail"].get<std::string>(), one.says)) << response.body;
    EXPECT_EQ(parseJson(response.body)["status"], one.status);
  }
  EXPECT_TRUE(server.ask(makeGet("/measurements")).has("Allow: POST"));
  EXPECT_TRUE(server.ask(makePost("a", "/state")).has("Allow: GET, HEAD"));
  EXPECT_EQ(server.service.answered, 0);
  EXPECT_EQ(server.ask(makePost("good")).status, 200);
}

TEST(TwinServer, AsksForItsToken) {
  Access access;
  access.token = kToken;
  RunningServer server({}, access);
  for (const char* path : {"/", "/state", "/health", "/metrics", "/events", "/nowhere"}) {
    const RawResponse response = server.ask(makeGet(path));
    EXPECT_EQ(response.status, 401) << path;
    EXPECT_TRUE(says(response.head, "WWW-Authenticate: Bearer realm=\"twinmap\"")) << path;
  }
  const auto ask = [&](const std::string& field) {
    return server.ask(makeGet("/state", "Authorization: " + field + "\r\n")).status;
  };
  EXPECT_EQ(ask("Bearer " + std::string(kToken)), 200);
  EXPECT_EQ(ask("Basic dHdpbjowMTIzNDU2Nzg5YWJjZGVmLXRva2Vu"), 200);  // twin:TOKEN
  for (const std::string wrong :
       {"Bearer 0123456789abcdef-tokex", "Bearer 0123456789abcdef-toke", "Bearer 0123456789abcdef-tokenn",
        "Bearer ", "Basic dHdpbjp4", "Basic !!!!", "Digest x", "0123456789abcdef-token"}) {
    EXPECT_EQ(ask(wrong), 401) << wrong;
  }
  // another's name is no matter then
  EXPECT_EQ(server
                .ask("GET /state HTTP/1.1\r\nHost: twin.example.com\r\nAuthorization: Bearer " +
                     std::string(kToken) + "\r\n\r\n")
                .status,
            200);
}

TEST(TwinServer, IsReadByThisMachineAlone) {
  RunningServer server;
  const auto ask = [&](const std::string& host) {
    return server.ask("GET /state HTTP/1.1\r\nHost: " + host + "\r\n\r\n").status;
  };
  for (const char* own :
       {"localhost", "localhost:99", "127.0.0.1:8765", "127.1.2.3", "[::1]:8765", "[::1]"}) {
    EXPECT_EQ(ask(own), 200) << own;
  }
  for (const char* other : {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "10.0.0.1",
                            "[::2]", "[", "::1", ""}) {
    EXPECT_NE(ask(other), 200) << other;
  }
  EXPECT_EQ(ask("evil.example"), 421);
}

TEST(TwinServer, IsNotWrittenByPagesOfOtherOrigins) {
  RunningServer server;
  const auto post = [&](const std::string& origin) {
    return server.ask(makePost("a", "/measurements", "text/csv", "Origin: " + origin + "\r\n")).status;
  };
  EXPECT_EQ(post("https://evil.example"), 403);
  EXPECT_EQ(post("null"), 403);
  EXPECT_EQ(post("http://localhost:1"), 403);
  EXPECT_EQ(post("http://localhost"), 200);
  EXPECT_EQ(
      server.ask("OPTIONS /measurements HTTP/1.1\r\nHost: localhost\r\nOrigin: https://evil.example\r\n\r\n")
          .status,
      405);  // so browsers send no text/csv from elsewhere
}

TEST(TwinServer, AnswersOnceAndOnlyWhatIsOnDisk) {
  RunningServer server;
  server.service.commit_duration = std::chrono::milliseconds(2);
  constexpr int kWriters = 8, kEach = 50;
  std::mutex mutex;
  std::set<int> numbers;
  std::vector<std::thread> clients;
  for (int c = 0; c < kWriters; ++c) {
    clients.emplace_back([&] {
      RawClient client(server.getPort());
      for (int i = 0; i < kEach; ++i) {
        const Json answer = parseJson(client.ask(makePost("a")).body);
        const int number = answer["track"]["measurements"].get<int>();
        EXPECT_LE(number, server.service.committed);
        const std::lock_guard<std::mutex> lock(mutex);
        EXPECT_TRUE(numbers.insert(number).second);
      }
    });
  }
  for (std::thread& client : clients) {
    client.join();
  }
  EXPECT_EQ(numbers.size(), static_cast<std::size_t>(kWriters * kEach));
  EXPECT_EQ(*numbers.rbegin(), kWriters * kEach);
  EXPECT_LT(server.service.commits, kWriters * kEach / 2);  // several together
}

TEST(TwinServer, EndsWhereTheTwinCannotBeWritten) {
  RunningServer server;
  EXPECT_EQ(server.ask(makePost("a")).status, 200);
  RawClient watching(server.getPort());
  EXPECT_EQ(watching.ask(makeGet("/health")).status, 200);
  server.service.disk_is_full = true;
  const RawResponse response = server.ask(makePost("a"));
  EXPECT_EQ(response.status, 500);
  EXPECT_TRUE(says(response.body, "No space left on device"));
  EXPECT_THROW(server.finish(), std::runtime_error);
  EXPECT_EQ(server.service.committed, 1);
}

TEST(TwinServer, DescribesItself) {
  RunningServer server;
  for (const Route& route : listRoutes()) {
    const RawResponse response = server.ask(route.path == "/events"  ? makeGet("/events")
                                            : route.method == "POST" ? makePost("a", route.path)
                                                                     : makeGet(route.path));
    EXPECT_EQ(response.status, 200) << route.path;
    EXPECT_TRUE(response.has("X-Content-Type-Options: nosniff")) << route.path;
    EXPECT_TRUE(response.has("Cache-Control: no-store")) << route.path;
  }
  EXPECT_TRUE(says(server.ask(makeGet("/")).head, "Content-Security-Policy: default-src 'none'"));
  EXPECT_TRUE(says(server.ask(makeGet("/page")).head, "Content-Security-Policy: default-src 'none'"));
  EXPECT_TRUE(says(server.ask(makeGet("/page")).body, "<title>whole"));
  EXPECT_TRUE(says(server.ask(makeGet("/history?last=1")).body, "\n1,\"a, b.csv\",ok,1,k,"));
}

TEST(TwinServer, HasTheRoutesOfItsOpenApi) {
  const Json paths = parseJson(getOpenApi())["paths"];
  EXPECT_EQ(paths.size(), listRoutes().size());
  for (const Route& route : listRoutes()) {
    ASSERT_TRUE(paths.contains(route.path)) << route.path;
    const std::string method = route.method == "GET" ? "get" : "post";
    ASSERT_TRUE(paths[route.path].contains(method)) << route.path;
    std::vector<std::string> query;
    for (const Json& parameter : paths[route.path][method].value("parameters", Json::array())) {
      query.push_back(parameter["name"]);
    }
    EXPECT_EQ(std::set<std::string>(query.begin(), query.end()),
              std::set<std::string>(route.query.begin(), route.query.end()))
        << route.path;
  }
}

TEST(TwinServer, CountsForPrometheus) {
  RunningServer server;
  RawClient client(server.getPort());
  client.ask(makePost("a"));
  client.ask(makePost("bad"));
  client.ask(makeGet("/nowhere"));
  const std::string text = client.ask(makeGet("/metrics")).body;
  for (const char* line :
       {"twinmap_build_info{version=\"1.2.3\"} 1", "twinmap_http_requests_total{code=\"200\"} 1",
        "twinmap_http_requests_total{code=\"422\"} 1", "twinmap_http_requests_total{code=\"404\"} 1",
        "twinmap_measurements_total{status=\"ok\"} 1", "twinmap_measurements_total{status=\"error\"} 1",
        "twinmap_measurement_duration_seconds_bucket{le=\"+Inf\"} 2",
        "twinmap_measurement_duration_seconds_count 2", "twinmap_belief_measurements 1",
        "twinmap_parameter_mean{parameter=\"k \\\"0\\\"\"} 95", "twinmap_http_connections 1"}) {
    EXPECT_TRUE(says(text, std::string(line) + "\n")) << line << "\n" << text;
  }
}

}  // namespace
