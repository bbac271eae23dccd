#include "framework/study/samples/chunk_saver.hpp"

#include <algorithm>

namespace twinmap {
namespace {

/// As many samples as asked for, but not above 32 MiB, for samples may be of any size.
std::size_t chooseChunkSamples(const TrajectoryStore& store, const MissingOptions& options) {
  constexpr std::uint64_t kMaxBytes = 32u << 20;
  const std::uint64_t fitting = kMaxBytes / calcChunkSize(store.getShape(), 1);
  const auto wanted = static_cast<std::uint64_t>(std::max(options.chunk_samples, 1));
  return std::clamp<std::uint64_t>(fitting, 1, wanted);
}

}  // namespace

ChunkSaver::ChunkSaver(TrajectoryStore& store, const MissingOptions& options,
                       const SimulationProgress& counts)
    : store_(store), options_(options), chunk_samples_(chooseChunkSamples(store, options)), counts_(counts) {}

void ChunkSaver::addOne(const Trajectories& all, int sample) {
  waiting_.push_back({all.parameters.col(sample), all.responses.col(sample), all.statuses[sample]});
  ++counts_.simulated;
  counts_.failed += all.statuses[sample].ok ? 0 : 1;
  counts_.implicit += all.statuses[sample].ok && all.statuses[sample].stiff_retry ? 1 : 0;
  if (options_.progress) {
    options_.progress(counts_);
  }
}

bool ChunkSaver::isDue() const {
  const std::chrono::duration<double> waited = Clock::now() - last_chunk_;
  return waiting_.size() >= chunk_samples_ || waited.count() >= options_.chunk_seconds;
}

std::vector<ChunkSaver::Sample> ChunkSaver::takeDue() {
  std::vector<Sample> taken;
  if (isDue()) {
    taken.swap(waiting_);
    last_chunk_ = Clock::now();
  }
  return taken;
}

void ChunkSaver::add(const Trajectories& all, int first, int count) {
  std::vector<Sample> due;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    for (int sample = first; sample < first + count; ++sample) {
      addOne(all, sample);
    }
    due = takeDue();
  }
  write(due);
}

void ChunkSaver::flush() {
  write(waiting_);
  waiting_.clear();
}

void ChunkSaver::write(const std::vector<Sample>& samples) {
  if (samples.empty()) {
    return;
  }
  const auto count = static_cast<Eigen::Index>(samples.size());
  SampleBlock block;
  block.parameters.resize(samples.front().parameters.size(), count);
  block.responses.resize(samples.front().response.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    block.parameters.col(i) = samples[i].parameters;
    block.responses.col(i) = samples[i].response;
    block.statuses.push_back(samples[i].status);
  }
  store_.append(block);
}

}  // namespace twinmap
