#pragma once

#include <Eigen/Core>
#include <string>

#include "framework/base/worker/worker_process.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap::fmi {

/// The first argument of this program that makes it a worker: `twinmap fmu-worker`.
constexpr const char* kWorkerArgument = "fmu-worker";

/// Answers requests of encodeJob(), encodePoints() and encodePoint() with one FMU in this process. Never
/// returns.
[[noreturn]] void runWorker();

/// What a request for samples begins with.
enum class Request : char { kResponses, kDerivatives };

// Frames of bytes. A job is answered by an empty reason, or why the FMU cannot be used.
Frame encodeJob(const std::string& job);
/// Of one point, or of a centre and its neighbours, which share its integration steps.
Frame encodePoints(const Eigen::Ref<const Eigen::MatrixXd>& parameters);
/// Of a point whose response and derivatives are asked for: in the answer they follow one another, column by
/// column.
Frame encodePoint(const Eigen::Ref<const Eigen::VectorXd>& point);
Frame encodeAnswer(const SampleStatus& status, const Eigen::Ref<const Eigen::VectorXd>& response);
/// Takes the first of the answers off the frame, from `begin` on. The response is written where the status is
/// ok. Throws WorkerFailure for another size.
SampleStatus decodeAnswer(const Frame& frame, std::size_t& begin, Eigen::Ref<Eigen::VectorXd> response);

}  // namespace twinmap::fmi
