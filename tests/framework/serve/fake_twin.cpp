// A live twin without a machine, for tests of the page and for bench/serve.py:
// twinmap_fake_twin PORT [MILLISECONDS OF AN ANSWER [MILLISECONDS OF A COMMIT]]. Ends at the end of its
// input.
#include <iostream>
#include <limits>
#include <string>
#include <thread>

#include "framework/serve/live/twin_server.hpp"
#include "tests/framework/serve/fake_service.hpp"

int main(int count, char** arguments) {
  using namespace twinmap::serve;
  FakeService service;
  const auto get = [&](int place) { return count > place ? std::stoi(arguments[place]) : 0; };
  service.duration = std::chrono::milliseconds(get(2));
  service.commit_duration = std::chrono::milliseconds(get(3));
  TwinServer server(service, {"127.0.0.1", static_cast<unsigned short>(get(1))}, {}, {}, "test");
  std::thread running([&server] { server.run(); });
  std::cout << server.getPort() << std::endl;
  std::cin.ignore(std::numeric_limits<std::streamsize>::max());
  server.stop();
  running.join();
}
