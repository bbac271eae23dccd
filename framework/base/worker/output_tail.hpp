#pragma once

#include <string>

namespace twinmap {

/// What a process says on a pipe: the last of it, for the reason of a failure.
class OutputTail {
 public:
  OutputTail() = default;
  OutputTail(const OutputTail&) = delete;
  OutputTail& operator=(const OutputTail&) = delete;
  ~OutputTail();

  /// Takes over the end of a pipe to read from, which does not block.
  void open(int file) { file_ = file; }
  /// For poll(): -1 where nothing more can come.
  int getFile() const { return file_; }

  /// Takes what is there now.
  void read();
  void keep(const std::string& text);
  /// Takes what is there and forgets it: it belongs to what was done before.
  void forget();
  /// "; it said: ..." or "".
  std::string describe() const;

 private:
  int file_ = -1;
  std::string text_;
};

/// How a process ended, of which waitpid() gave `status`: "the program crashed: Aborted".
std::string describeEnd(const std::string& process, int status);

}  // namespace twinmap
