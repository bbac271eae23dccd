#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace twinmap::serve {

struct RawResponse {
  int status = 0;  ///< 0: the connection ended without one
  std::string head, body;

  bool has(const std::string& line) const { return head.find(line + "\r\n") != std::string::npos; }
};

/// A connection over which a test says what it wants, byte for byte.
class RawClient {
 public:
  /// window: bytes that the system holds for a client that does not read; 0: its own choice.
  explicit RawClient(unsigned short port, int window = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (window > 0) {
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &window, sizeof(window));
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{60, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  ~RawClient() { ::close(socket_); }

  /// False where the server has closed.
  bool send(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) {
        return false;
      }
      sent += static_cast<std::size_t>(count);
    }
    return true;
  }

  void endSending() const { ::shutdown(socket_, SHUT_WR); }

  /// One response, whose body has a length or goes on to the end (`is_head`: has none).
  RawResponse read(bool is_head = false) {
    RawResponse response;
    while (buffer_.find("\r\n\r\n") == std::string::npos && receive()) {
    }
    const std::size_t end = buffer_.find("\r\n\r\n");
    if (end == std::string::npos) {
      return response;
    }
    response.head = buffer_.substr(0, end + 4);
    buffer_.erase(0, end + 4);
    response.status = std::stoi(response.head.substr(9, 3));
    const std::size_t length = response.head.find("Content-Length: ");
    if (!is_head && length != std::string::npos) {
      response.body = readBytes(std::stoul(response.head.substr(length + 16)));
    }
    return response;
  }

  RawResponse ask(const std::string& request) {
    send(request);
    return read();
  }

  /// Up to and with `mark`; what came where it never does.
  std::string readUntil(const std::string& mark) {
    while (buffer_.find(mark) == std::string::npos && receive()) {
    }
    const std::size_t found = buffer_.find(mark);
    return readBytes(found == std::string::npos ? buffer_.size() : found + mark.size());
  }

  /// All that is left, until the server closes.
  std::string readAll() {
    while (receive()) {
    }
    return readBytes(buffer_.size());
  }

 private:
  std::string readBytes(std::size_t count) {
    while (buffer_.size() < count && receive()) {
    }
    const std::string bytes = buffer_.substr(0, count);
    buffer_.erase(0, count);
    return bytes;
  }

  bool receive() {
    char bytes[65536];
    const ssize_t count = ::recv(socket_, bytes, sizeof(bytes), 0);
    if (count > 0) {
      buffer_.append(bytes, static_cast<std::size_t>(count));
    }
    return count > 0;
  }

  const int socket_;
  std::string buffer_;
};

/// fields: whole lines.
inline std::string makeGet(const std::string& target, const std::string& fields = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

inline std::string makePost(const std::string& body, const std::string& target = "/measurements",
                            const std::string& type = "text/csv", const std::string& fields = "") {
  return "POST " + target + " HTTP/1.1\r\nHost: localhost\r\nContent-Type: " + type + "\r\n" + fields +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

}  // namespace twinmap::serve
