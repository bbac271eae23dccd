#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>
#include <vector>

#include "tests/case_turns.hpp"
#include "tests/framework/serve/running_server.hpp"

using namespace twinmap::serve;

namespace {

constexpr int kCases = 20000, kAllCases = 100000, kClients = 24;
constexpr std::size_t kMostGrowth = std::size_t{64} << 20;  // bytes

using Random = std::mt19937_64;

std::size_t draw(Random& random, std::size_t count) {
  return count == 0 ? 0 : random() % count;
}

std::string drawBytes(Random& random, std::size_t most) {
  std::string bytes(draw(random, most), ' ');
  for (char& byte : bytes) {
    byte = static_cast<char>(random());
  }
  return bytes;
}

const std::vector<std::string>& listRequests() {
  static const std::vector<std::string> requests{
      makeGet("/"),
      makeGet("/state", "Accept: */*\r\nConnection: keep-alive\r\n"),
      makeGet("/history?last=10"),
      makeGet("/events"),
      "HEAD /metrics HTTP/1.1\r\nHost: 127.0.0.1:8765\r\n\r\n",
      makePost("t,x\n0,1\n0.1,2\n"),
      makePost("t,x\n0,1\n", "/measurements?at=2026-11-26T10%3A00%3A00Z&name=a.csv&trial=b"),
      makePost(R"({"columns": {"t": [0, 0.1], "x": [1, null]}, "at": 3})", "/measurements",
               "application/json"),
      "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nTransfer-Encoding: "
      "chunked\r\n\r\n8\r\nt,x\n0,1\n\r\n4\r\n1,2\n\r\n0\r\n\r\n",
      makeGet("/../../../../etc/passwd"),
      makeGet("/%2e%2e/%2e%2e/etc/passwd"),
      makeGet("//etc/passwd"),
      makeGet("/events/../state")};
  return requests;
}

/// What stands for a part of a request that a server reads.
std::string drawToken(Random& random) {
  static const std::vector<std::string> tokens{"\r\n",
                                               "\r\n\r\n",
                                               "\n",
                                               "\r",
                                               ":",
                                               " ",
                                               "\t",
                                               "%00",
                                               "../",
                                               "0",
                                               "-1",
                                               "ffffffffffffffff",
                                               "99999999999999999999",
                                               "Content-Length: 5\r\n",
                                               "Content-Length: 70000000\r\n",
                                               "Transfer-Encoding: chunked\r\n",
                                               "Expect: 100-continue\r\n",
                                               "Host: evil\r\n",
                                               "Connection: close\r\n",
                                               "Upgrade: h2c\r\n",
                                               "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
                                               "0\r\n\r\n",
                                               std::string(1, '\0'),
                                               std::string(9000, 'a'),
                                               std::string(100, '{'),
                                               "\xff\xfe"};
  return tokens[draw(random, tokens.size())];
}

std::string mutate(std::string request, Random& random) {
  for (std::size_t changes = 1 + draw(random, 4); changes > 0; --changes) {
    const std::size_t at = draw(random, request.size() + 1), length = draw(random, request.size() - at + 1);
    switch (draw(random, 6)) {
      case 0:
        request.insert(at, drawToken(random));
        break;
      case 1:
        request.replace(at, std::min<std::size_t>(length, 20), drawToken(random));
        break;
      case 2:
        request.erase(at, length);
        break;
      case 3:
        request.insert(at, request.substr(at, length));
        break;
      case 4:
        request.resize(at);
        break;
      default:
        if (at < request.size()) {
          request[at] = static_cast<char>(random());
        }
    }
  }
  return request;
}

std::string makeCase(int number) {
  Random random(static_cast<Random::result_type>(number));
  const auto& requests = listRequests();
  switch (draw(random, 10)) {
    case 0:
      return drawBytes(random, 20000);
    case 1:
      return requests[draw(random, requests.size())] +
             mutate(requests[draw(random, requests.size())], random);
    default:
      return mutate(requests[draw(random, requests.size())], random);
  }
}

/// Bytes of this process that are in memory.
std::size_t getMemory() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Sends it at once or in two parts, and says what came until the server closed.
std::string sendCase(unsigned short port, int number) {
  RawClient client(port);
  const std::string request = makeCase(number);
  const std::size_t half = number % 3 == 0 ? request.size() / 2 : request.size();
  if (client.send(request.substr(0, half)) && half < request.size()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    client.send(request.substr(half));
  }
  if (number % 2 == 0) {
    client.endSending();
  }
  const std::string answer = client.readUntil("text/event-stream");
  client.endSending();  // which ends what has no end
  return answer + client.readAll();
}

/// Each answer is one of HTTP, and none says that the server broke or shows a file.
void requireSound(const std::string& answer, int number) {
  EXPECT_EQ(answer.find("root:"), std::string::npos) << number;
  if (answer.empty()) {
    return;
  }
  ASSERT_EQ(answer.rfind("HTTP/1.1 ", 0), 0U) << number << ": " << answer;
  for (std::size_t at = 0; (at = answer.find("HTTP/1.1 ", at)) != std::string::npos; ++at) {
    const std::string status = answer.substr(at + 9, 3);
    EXPECT_TRUE(status == "200" || status == "100" || status[0] == '4') << number << ": " << answer;
  }
}

TEST(MutatedRequests, AreAnsweredOrClosedInLittleMemory) {
  HttpLimits limits;
  limits.request = limits.idle = std::chrono::milliseconds(50);
  limits.heartbeat = std::chrono::milliseconds(10);  // so that streams end as soon as nobody reads them
  RunningServer server(limits);
  requireSound(sendCase(server.getPort(), 1), 1);
  const std::size_t before = getMemory();
  const std::vector<int> cases =
      twinmap::testing::takeTurn(std::getenv("TWINMAP_ALL_CASES") == nullptr ? kCases : kAllCases);
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> clients;
  for (int c = 0; c < kClients; ++c) {
    clients.emplace_back([&] {
      for (std::size_t i = next++; i < cases.size(); i = next++) {
        requireSound(sendCase(server.getPort(), cases[i]), cases[i]);
      }
    });
  }
  for (std::thread& client : clients) {
    client.join();
  }
  EXPECT_LT(getMemory(), before + kMostGrowth);
  EXPECT_EQ(server.ask(makeGet("/health")).status, 200);
}

}  // namespace
