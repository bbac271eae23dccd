#include <cstring>

#include "framework/fmi/worker.hpp"

namespace twinmap::fmi {
namespace {

void append(Frame& frame, const void* bytes, std::size_t size) {
  const char* begin = static_cast<const char*>(bytes);
  frame.insert(frame.end(), begin, begin + size);
}

}  // namespace

Frame encodeJob(const std::string& job) {
  return {job.begin(), job.end()};
}

Frame encodePoint(const Eigen::Ref<const Eigen::VectorXd>& parameters) {
  Frame frame;
  append(frame, parameters.data(), static_cast<std::size_t>(parameters.size()) * sizeof(double));
  return frame;
}

Frame encodeAnswer(const SampleStatus& status, const Eigen::Ref<const Eigen::VectorXd>& response) {
  Frame frame{static_cast<char>(status.ok), static_cast<char>(status.machine_dependent), 0};
  if (status.ok) {
    append(frame, response.data(), static_cast<std::size_t>(response.size()) * sizeof(double));
  } else {
    append(frame, status.reason.data(), status.reason.size());
  }
  return frame;
}

SampleStatus decodeAnswer(const Frame& frame, Eigen::Ref<Eigen::VectorXd> response, bool& last) {
  constexpr std::size_t kHead = 3;
  const std::size_t size = static_cast<std::size_t>(response.size()) * sizeof(double);
  if (frame.size() < kHead || (frame[0] != 0 && frame.size() != kHead + size)) {
    throw WorkerFailure("the model's process answers with a response of another size");
  }
  last = frame[2] != 0;
  if (frame[0] == 0) {
    return {false, std::string(frame.begin() + kHead, frame.end()), frame[1] != 0};
  }
  std::memcpy(response.data(), frame.data() + kHead, size);
  return {};
}

}  // namespace twinmap::fmi
