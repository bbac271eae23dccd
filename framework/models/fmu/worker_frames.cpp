#include <cstdint>
#include <cstring>

#include "framework/models/fmu/worker.hpp"

namespace twinmap::fmi {
namespace {

void append(Frame& frame, const void* bytes, std::size_t size) {
  const std::size_t before = frame.size();
  frame.resize(before + size);  // not insert(), for which GCC 12 reports overflows that there are none
  std::memcpy(frame.data() + before, bytes, size);
}

/// What an answer begins with.
struct AnswerHead {
  std::uint64_t size;  ///< of what follows, bytes: the response, or why there is none
  bool ok, machine_dependent, stiff_retry;
};

}  // namespace

Frame encodeJob(const std::string& job) {
  return {job.begin(), job.end()};
}

Frame encodePoints(const Eigen::Ref<const Eigen::MatrixXd>& parameters) {
  Frame frame{static_cast<char>(Request::kResponses)};
  for (const auto& column : parameters.colwise()) {
    append(frame, column.data(), static_cast<std::size_t>(column.size()) * sizeof(double));
  }
  return frame;
}

Frame encodePoint(const Eigen::Ref<const Eigen::VectorXd>& point) {
  Frame frame{static_cast<char>(Request::kDerivatives)};
  append(frame, point.data(), static_cast<std::size_t>(point.size()) * sizeof(double));
  return frame;
}

Frame encodeAnswer(const SampleStatus& status, const Eigen::Ref<const Eigen::VectorXd>& response) {
  const std::size_t size =
      status.ok ? static_cast<std::size_t>(response.size()) * sizeof(double) : status.reason.size();
  const AnswerHead head{size, status.ok, status.machine_dependent, status.stiff_retry};
  Frame frame;
  append(frame, &head, sizeof head);
  append(frame, status.ok ? static_cast<const void*>(response.data()) : status.reason.data(), size);
  return frame;
}

SampleStatus decodeAnswer(const Frame& frame, std::size_t& begin, Eigen::Ref<Eigen::VectorXd> response) {
  AnswerHead head{};
  const std::size_t size = static_cast<std::size_t>(response.size()) * sizeof(double);
  const bool has_head = frame.size() >= begin + sizeof head;
  if (has_head) {
    std::memcpy(&head, frame.data() + begin, sizeof head);
    begin += sizeof head;
  }
  if (!has_head || head.size > frame.size() - begin || (head.ok && head.size != size)) {
    throw WorkerFailure("the model's process answers with a response of another size");
  }
  const char* content = frame.data() + begin;
  begin += head.size;
  if (!head.ok) {
    return {false, std::string(content, head.size), head.machine_dependent, head.stiff_retry};
  }
  std::memcpy(response.data(), content, size);
  SampleStatus status;
  status.stiff_retry = head.stiff_retry;
  return status;
}

}  // namespace twinmap::fmi
