#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/framework/serve/running_server.hpp"

using namespace twinmap::serve;

namespace {

using std::chrono::milliseconds;

HttpLimits makeImpatient() {
  HttpLimits limits;
  limits.request = limits.idle = milliseconds(150);
  limits.linger = milliseconds(50);
  return limits;
}

TEST(HttpServer, AnswersPipelinedRequestsInTheirOrder) {
  RunningServer server;
  RawClient client(server.getPort());
  client.send(makePost("one") + makePost("two") + makeGet("/state"));
  EXPECT_NE(client.read().body.find("\"text\":\"one\""), std::string::npos);
  EXPECT_NE(client.read().body.find("\"text\":\"two\""), std::string::npos);
  EXPECT_NE(client.read().body.find("\"measurements\":2"), std::string::npos);
}

TEST(HttpServer, ReadsChunkedBodies) {
  RunningServer server;
  const std::string head =
      "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nTransfer-Encoding: "
      "chunked\r\n\r\n";
  RawClient client(server.getPort());
  const RawResponse response = client.ask(head + "3\r\nab,\r\n4;x=1\r\n1\n2\n\r\n0\r\nTrailer: t\r\n\r\n");
  EXPECT_EQ(response.status, 200);
  EXPECT_NE(response.body.find(R"("text":"ab,1\n2\n")"), std::string::npos) << response.body;
  EXPECT_EQ(client.ask(makeGet("/health")).status, 200);  // the connection goes on after the trailer
}

TEST(HttpServer, AsksForTheBodyWhereTheClientWaits) {
  RunningServer server;
  RawClient client(server.getPort());
  client.send(
      "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nExpect: "
      "100-continue\r\nContent-Length: 3\r\n\r\n");
  EXPECT_EQ(client.readUntil("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  EXPECT_EQ(client.ask("a,b").status, 200);
}

TEST(HttpServer, AnswersHeadWithoutABody) {
  RunningServer server;
  RawClient client(server.getPort());
  client.send("HEAD /state HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const RawResponse head = client.read(true);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.head.find("Content-Length: 0\r\n"), std::string::npos);
  client.send("HEAD /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(client.read(true).status, 200);
  EXPECT_EQ(client.ask(makeGet("/health")).status, 200);
}

TEST(HttpServer, ClosesWhereTheClientAsksForIt) {
  RunningServer server;
  RawClient client(server.getPort());
  client.send(makeGet("/health", "Connection: close\r\n"));
  EXPECT_TRUE(client.read().has("Connection: close"));
  EXPECT_EQ(client.readAll(), "");
}

TEST(HttpServer, RefusesHeadersBeyondTheLimit) {
  HttpLimits limits;
  limits.linger = milliseconds(50);
  RunningServer server(limits);
  const std::string small(7000, 'a'), large(9000, 'a');
  EXPECT_EQ(server.ask(makeGet("/health", "X: " + small + "\r\n")).status, 200);
  EXPECT_EQ(server.ask(makeGet("/health", "X: " + large + "\r\n")).status, 431);
  EXPECT_EQ(server.ask(makeGet("/" + large)).status, 431);
  RawClient endless(server.getPort());
  while (endless.send(std::string(1000, 'a'))) {  // until the server has closed
  }
}

TEST(HttpServer, RefusesBodiesBeyondTheLimit) {
  HttpLimits limits;
  limits.body = 1000;
  RunningServer server(limits);
  EXPECT_EQ(server.ask(makePost(std::string(1000, 'a'))).status, 200);
  EXPECT_EQ(server.ask(makePost(std::string(1001, 'a'))).status, 413);
  RawClient client(server.getPort());
  client.send(
      "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nTransfer-Encoding: "
      "chunked\r\n\r\n");
  for (int i = 0; i < 3; ++i) {
    client.send("1f4\r\n" + std::string(500, 'a') + "\r\n");
  }
  EXPECT_EQ(client.read().status, 413);
  EXPECT_EQ(server.service.answered, 1);
}

TEST(HttpServer, RefusesBodiesThatTogetherAreBeyondTheLimit) {
  HttpLimits limits;
  limits.bodies = 1000;
  RunningServer server(limits);
  {
    RawClient first(server.getPort());
    first.send(
        "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nContent-Length: "
        "800\r\n\r\n");
    RawResponse second;
    do {  // until the first one's header was read
      second = server.ask(makePost(std::string(300, 'a')));
    } while (second.status == 200);
    EXPECT_EQ(second.status, 429);
    EXPECT_TRUE(second.has("Retry-After: 1"));
    EXPECT_EQ(first.ask(std::string(800, 'b')).status, 200);
  }
  EXPECT_EQ(server.ask(makePost(std::string(300, 'a'))).status, 200);
}

TEST(HttpServer, AnswersSlowSenders) {
  RunningServer server(makeImpatient());
  for (const std::string begin : {"GET /state HT", "POST /measurements HTTP/1.1\r\nHost: localhost\r\n",
                                  "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                                  "text/csv\r\nContent-Length: 9\r\n\r\nabc"}) {
    RawClient client(server.getPort());
    EXPECT_EQ(client.ask(begin).status, 408) << begin;
    EXPECT_EQ(client.readAll(), "");
  }
  RawClient dripping(server.getPort());
  for (int i = 0; i < 40 && dripping.send("a"); ++i) {  // 10 ms apart: the time is that of the whole request
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_EQ(dripping.read().status, 408);
}

TEST(HttpServer, ClosesConnectionsThatSayNothing) {
  RunningServer server(makeImpatient());
  EXPECT_EQ(RawClient(server.getPort()).readAll(), "");
  RawClient client(server.getPort());
  EXPECT_EQ(client.ask(makeGet("/health")).status, 200);
  EXPECT_EQ(client.readAll(), "");
}

TEST(HttpServer, RefusesConnectionsBeyondTheLimit) {
  HttpLimits limits;
  limits.connections = 3;
  RunningServer server(limits);
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(std::make_unique<RawClient>(server.getPort()));
    EXPECT_EQ(clients.back()->ask(makeGet("/health")).status, 200);
  }
  RawClient beyond(server.getPort());
  EXPECT_EQ(beyond.read().status, 429);
  clients.clear();
  RawResponse response;
  do {  // until the server has seen that they are gone
    response = server.ask(makeGet("/health"));
  } while (response.status == 429);
  EXPECT_EQ(response.status, 200);
}

TEST(HttpServer, RefusesWhatIsNotHttp) {
  RunningServer server;
  const std::string post = "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\n";
  for (const std::string& request : std::vector<std::string>{
           "hello\r\n\r\n", "GET / HTTP/3.7\r\nHost: localhost\r\n\r\n", "GET / HTTP/1.1\r\n\r\n",
           "GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n",
           "GET / HTTP/1.1\r\nHost : localhost\r\n\r\n", post + "Content-Length: -1\r\n\r\n",
           post + "Content-Length: 3\r\nContent-Length: 4\r\n\r\nabcd",
           post + "Content-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n",
           post + "Transfer-Encoding: gzip, chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n",
           post + "Transfer-Encoding: chunked\r\n\r\nxyz\r\n"}) {
    RawClient client(server.getPort());
    const RawResponse response = client.ask(request);
    EXPECT_EQ(response.status, 400) << request;
    EXPECT_TRUE(response.has("Content-Type: application/problem+json")) << request;
    EXPECT_EQ(client.readAll(), "") << request;
  }
  EXPECT_EQ(server.service.answered, 0);
}

TEST(HttpServer, StreamsEventsToEachPage) {
  RunningServer server;
  RawClient first(server.getPort()), second(server.getPort());
  for (RawClient* page : {&first, &second}) {
    page->send(makeGet("/events"));
    EXPECT_NE(page->readUntil("\r\n\r\n").find("text/event-stream"), std::string::npos);
    EXPECT_NE(page->readUntil("\n\n").find("data: {\"state\": {\"measurements\":0"), std::string::npos);
  }
  EXPECT_EQ(server.ask(makePost("a")).status, 200);
  for (RawClient* page : {&first, &second}) {
    const std::string event = page->readUntil("\n\n");
    EXPECT_EQ(event.find("event: belief\ndata: {\"state\": {\"measurements\":1"), 0U) << event;
    EXPECT_NE(event.find("\"answer\": {\"source\""), std::string::npos);
  }
}

TEST(HttpServer, GivesAPageThatDoesNotReadTheNewestEventAlone) {
  RunningServer server;
  RawClient page(server.getPort(), 4096), client(server.getPort());
  page.send(makeGet("/events"));
  page.readUntil("\n\n");
  constexpr int kMany = 2000;  // of 4 kB: more than a socket holds
  const std::string request = makePost("a", "/measurements?name=" + std::string(4000, 'n'));
  for (int sent = 0; sent < kMany; sent += 100) {
    std::string requests;
    for (int i = 0; i < 100; ++i) {
      requests += request;
    }
    client.send(requests);
    for (int i = 0; i < 100; ++i) {
      ASSERT_EQ(client.read().status, 200);
    }
  }
  int events = 0;
  std::string event;
  do {
    event = page.readUntil("\n\n");
    ++events;
  } while (!event.empty() && event.find("\"measurements\":" + std::to_string(kMany)) == std::string::npos);
  EXPECT_FALSE(event.empty());
  EXPECT_LT(events, kMany);
}

TEST(HttpServer, KeepsPagesFromTakingAllConnections) {
  HttpLimits limits;
  limits.streams = 1;
  RunningServer server(limits);
  RawClient page(server.getPort());
  page.send(makeGet("/events"));
  page.readUntil("\n\n");
  EXPECT_EQ(server.ask(makeGet("/events")).status, 429);
}

TEST(HttpServer, ShowsThatAStreamLives) {
  HttpLimits limits;
  limits.heartbeat = milliseconds(20);
  RunningServer server(limits);
  RawClient page(server.getPort());
  page.send(makeGet("/events"));
  EXPECT_NE(page.readUntil(": \n\n: \n\n").find(": \n\n: \n\n"), std::string::npos);
}

TEST(HttpServer, FinishesWhatItHasWhenItIsStopped) {
  HttpLimits limits;
  limits.linger = milliseconds(50);
  RunningServer server(limits);
  server.service.duration = milliseconds(200);
  RawClient working(server.getPort()), begun(server.getPort()), idle(server.getPort());
  EXPECT_EQ(idle.ask(makeGet("/health")).status, 200);
  begun.send(
      "POST /measurements HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nContent-Length: "
      "3\r\n\r\n");
  working.send(makePost("a"));
  std::this_thread::sleep_for(milliseconds(100));  // until both are there
  server.stop();
  EXPECT_EQ(idle.readAll(), "");
  begun.send("a,b");
  EXPECT_EQ(working.read().status, 200);
  const RawResponse last = begun.read();
  EXPECT_EQ(last.status, 200);
  EXPECT_TRUE(last.has("Connection: close"));
  server.finish();
  EXPECT_EQ(server.service.committed, 2);
  EXPECT_THROW(RawClient(server.getPort()), std::runtime_error);
}

TEST(HttpServer, SaysWhyAnAddressCannotBeHad) {
  RunningServer server;
  FakeService service;
  try {
    TwinServer second(service, ListenAddress{"127.0.0.1", server.getPort()}, {}, {}, "1");
    FAIL() << "two servers at one port";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("Address already in use"), std::string::npos) << error.what();
  }
}

}  // namespace
