#include "framework/base/worker/serve_frames.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <thread>

namespace twinmap {
namespace {

/// Waits until the other side has closed the channel.
[[noreturn]] void watch(int channel) {
  pollfd file{channel, POLLRDHUP, 0};
  while (poll(&file, 1, -1) < 0 || (file.revents & (POLLRDHUP | POLLHUP | POLLERR)) == 0) {
  }
  kill(0, SIGKILL);  // and whatever the model has started
  _exit(1);
}

void receive(int channel, char* data, std::size_t size) {
  for (std::size_t received = 0; received < size;) {
    const ssize_t count = recv(channel, data + received, size - received, 0);
    if (count > 0) {
      received += static_cast<std::size_t>(count);
    } else if (count == 0 || errno != EINTR) {
      _exit(0);
    }
  }
}

void send(int channel, const char* data, std::size_t size) {
  for (std::size_t sent = 0; sent < size;) {
    const ssize_t count = ::send(channel, data + sent, size - sent, MSG_NOSIGNAL);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      _exit(0);
    }
  }
}

}  // namespace

void serveFrames(const std::function<Frame(const Frame& request, bool& last)>& answer) {
  const int channel = fcntl(kWorkerChannel, F_DUPFD_CLOEXEC, kWorkerChannel + 1);
  close(kWorkerChannel);  // what the model starts does not inherit it
  std::thread(watch, channel).detach();
  for (bool last = false; !last;) {
    std::uint64_t size = 0;
    receive(channel, reinterpret_cast<char*>(&size), sizeof size);
    Frame request(size);
    receive(channel, request.data(), request.size());
    const Frame reply = answer(request, last);
    std::fflush(nullptr);  // what the model has printed belongs to this request
    const std::uint64_t reply_size = reply.size();
    send(channel, reinterpret_cast<const char*>(&reply_size), sizeof reply_size);
    send(channel, reply.data(), reply.size());
  }
  _exit(0);
}

}  // namespace twinmap
