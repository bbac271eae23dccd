#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/base/files/digest.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulated samples, one column each.
struct SampleBlock {
  Eigen::MatrixXd parameters;          ///< parameters x n
  Eigen::MatrixXd responses;           ///< rows x n; NaN where a sample failed
  std::vector<SampleStatus> statuses;  ///< n

  int getSampleCount() const { return static_cast<int>(parameters.cols()); }
};

/// What the samples of a store have in common.
struct ChunkShape {
  Digest content{};  ///< digest of what determines the samples
  Eigen::Index parameters = 0;
  Eigen::Index rows = 0;
};

/// Bytes that are no chunk, or no longer the chunk that was written, or one of other samples; the text says
/// why.
class BadChunk : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The bytes of a chunk file (docs/reference/files.md): header, parameters, responses, statuses, reasons, and
/// the digest of all of them. Equal samples give equal bytes.
std::string makeChunk(const SampleBlock& block, const ChunkShape& shape);

/// The samples of a chunk. Throws BadChunk unless every byte is as makeChunk() wrote it for this shape, and
/// std::runtime_error for an undamaged chunk of another format version.
SampleBlock readChunk(const std::string& bytes, const ChunkShape& shape);

/// What a chunk file says of its samples without their responses.
struct ChunkIndex {
  Eigen::MatrixXd parameters;  ///< parameters x n
  std::vector<bool> ok;        ///< n
};

/// What a chunk file says of itself in its header. Throws as readChunkIndex().
ChunkShape readChunkShape(const std::filesystem::path& file);

/// Reads the index of a chunk file, and not its responses, so that the checksum is not verified: what is
/// used must be read by readChunk(). Throws BadChunk where header and sizes are not those of a whole chunk
/// of this shape, and std::runtime_error as readChunk() and if the file cannot be read.
ChunkIndex readChunkIndex(const std::filesystem::path& file, const ChunkShape& shape);

/// Size of a chunk's file without the reasons of failed samples, bytes.
std::uint64_t calcChunkSize(const ChunkShape& shape, int samples);

}  // namespace twinmap
