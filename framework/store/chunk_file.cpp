#include "framework/store/chunk_file.hpp"

#include <fmt/core.h>

#include <cassert>
#include <cstring>
#include <fstream>
#include <string_view>

namespace twinmap {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "chunk files are little-endian");

constexpr char kMagic[8] = {'t', 'w', 'm', 'c', 'h', 'u', 'n', 'k'};
constexpr std::uint64_t kChunkVersion = 1;

struct Header {
  char magic[8];
  std::uint64_t version;
  Digest content;
  std::uint64_t parameters, rows, samples;
};
static_assert(sizeof(Header) == 56);

/// One a sample; the texts follow one another after the last.
struct StatusEntry {
  std::uint32_t ok, reason_size;
};

void appendBytes(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

/// Takes one piece after the other; a piece beyond the end is a bad chunk.
class Pieces {
 public:
  explicit Pieces(std::string_view bytes) : bytes_(bytes) {}

  void read(void* data, std::size_t size) {
    const std::string_view piece = take(size);
    if (size > 0) {
      std::memcpy(data, piece.data(), size);
    }
  }
  std::string readText(std::size_t size) { return std::string(take(size)); }
  std::size_t getRemaining() const { return bytes_.size(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) {
      throw BadChunk("its sizes do not fit the file");
    }
    const std::string_view piece = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return piece;
  }

  std::string_view bytes_;
};

Header makeHeader(const ChunkShape& shape, std::uint64_t samples) {
  Header header{{},
                kChunkVersion,
                shape.content,
                static_cast<std::uint64_t>(shape.parameters),
                static_cast<std::uint64_t>(shape.rows),
                samples};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  return header;
}

/// The bytes before the checksum.
std::string_view verifyChecksum(const std::string& bytes) {
  if (bytes.size() < sizeof kMagic + sizeof(Digest)) {
    throw BadChunk("it ends early");
  }
  if (std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    throw BadChunk("it does not begin as a chunk");
  }
  const std::string_view content(bytes.data(), bytes.size() - sizeof(Digest));
  const Digest digest = calcDigest(content.data(), content.size());
  if (std::memcmp(digest.data(), bytes.data() + content.size(), digest.size()) != 0) {
    throw BadChunk("its checksum is wrong");
  }
  return content;
}

void checkVersion(const Header& header) {
  if (header.version != kChunkVersion) {
    throw std::runtime_error(fmt::format("is a chunk of format version {}; this program reads version {}",
                                         header.version, kChunkVersion));
  }
}

void checkHeader(const Header& header, const ChunkShape& shape) {
  checkVersion(header);
  if (header.content != shape.content) {
    throw BadChunk("it holds samples of another model, " + toHex(header.content));
  }
  if (header.parameters != static_cast<std::uint64_t>(shape.parameters) ||
      header.rows != static_cast<std::uint64_t>(shape.rows)) {
    throw BadChunk("it has another number of parameters or rows");
  }
}

/// Reads pieces of a file of which the rest is not looked at.
class ChunkInput {
 public:
  explicit ChunkInput(const std::filesystem::path& file) : stream_(file, std::ios::binary) {
    if (!stream_) {
      throw std::runtime_error("cannot be opened");
    }
  }
  void read(std::uint64_t position, void* data, std::uint64_t size) {
    stream_.seekg(static_cast<std::streamoff>(position));
    if (!stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(size))) {
      throw BadChunk("it ends early");
    }
  }
  std::uint64_t getSize() {
    stream_.seekg(0, std::ios::end);
    return static_cast<std::uint64_t>(stream_.tellg());
  }

 private:
  std::ifstream stream_;
};

std::vector<SampleStatus> readStatuses(Pieces& pieces, std::uint64_t samples) {
  std::vector<StatusEntry> entries(samples);
  pieces.read(entries.data(), samples * sizeof(StatusEntry));
  std::vector<SampleStatus> statuses(samples);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    statuses[i].ok = entries[i].ok != 0;
    statuses[i].reason = pieces.readText(entries[i].reason_size);
  }
  return statuses;
}

Header readHeader(ChunkInput& input) {
  Header header;
  input.read(0, &header, sizeof header);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) {
    throw BadChunk("it does not begin as a chunk");
  }
  return header;
}

}  // namespace

ChunkShape readChunkShape(const std::filesystem::path& file) {
  ChunkInput input(file);
  const Header header = readHeader(input);
  checkVersion(header);
  return {header.content, static_cast<Eigen::Index>(header.parameters),
          static_cast<Eigen::Index>(header.rows)};
}

ChunkIndex readChunkIndex(const std::filesystem::path& file, const ChunkShape& shape) {
  ChunkInput input(file);
  const std::uint64_t size = input.getSize();
  const Header header = readHeader(input);
  checkHeader(header, shape);
  if (header.samples > size / sizeof(StatusEntry) ||
      calcChunkSize(shape, static_cast<int>(header.samples)) > size) {
    throw BadChunk("its sizes do not fit the file");
  }
  const std::uint64_t samples = header.samples;
  ChunkIndex index;
  index.parameters.resize(shape.parameters, static_cast<Eigen::Index>(samples));
  input.read(sizeof header, index.parameters.data(), index.parameters.size() * sizeof(double));
  std::vector<StatusEntry> entries(samples);
  const std::uint64_t numbers = samples * static_cast<std::uint64_t>(shape.parameters + shape.rows);
  input.read(sizeof header + numbers * sizeof(double), entries.data(), samples * sizeof(StatusEntry));
  std::uint64_t expected = calcChunkSize(shape, static_cast<int>(samples));
  for (const StatusEntry& entry : entries) {
    index.ok.push_back(entry.ok != 0);
    expected += entry.reason_size;
  }
  if (expected != size) {
    throw BadChunk("its sizes do not fit the file");
  }
  return index;
}

std::uint64_t calcChunkSize(const ChunkShape& shape, int samples) {
  const std::uint64_t numbers = static_cast<std::uint64_t>(shape.parameters + shape.rows);
  return sizeof(Header) + samples * (numbers * sizeof(double) + sizeof(StatusEntry)) + sizeof(Digest);
}

std::string makeChunk(const SampleBlock& block, const ChunkShape& shape) {
  assert(block.parameters.rows() == shape.parameters && block.responses.rows() == shape.rows);
  assert(block.responses.cols() == block.parameters.cols());
  assert(block.statuses.size() == static_cast<std::size_t>(block.parameters.cols()));
  const Header header = makeHeader(shape, block.statuses.size());
  std::string bytes;
  bytes.reserve(calcChunkSize(shape, block.getSampleCount()));
  appendBytes(bytes, &header, sizeof header);
  appendBytes(bytes, block.parameters.data(), block.parameters.size() * sizeof(double));
  appendBytes(bytes, block.responses.data(), block.responses.size() * sizeof(double));
  for (const SampleStatus& status : block.statuses) {
    const StatusEntry entry{status.ok ? 1u : 0u, static_cast<std::uint32_t>(status.reason.size())};
    appendBytes(bytes, &entry, sizeof entry);
  }
  for (const SampleStatus& status : block.statuses) {
    bytes += status.reason;
  }
  const Digest digest = calcDigest(bytes.data(), bytes.size());
  appendBytes(bytes, digest.data(), digest.size());
  return bytes;
}

SampleBlock readChunk(const std::string& bytes, const ChunkShape& shape) {
  Pieces pieces(verifyChecksum(bytes));
  Header header;
  pieces.read(&header, sizeof header);
  checkHeader(header, shape);
  if (header.samples > pieces.getRemaining() / sizeof(StatusEntry)) {
    throw BadChunk("its sizes do not fit the file");
  }
  SampleBlock block;
  const auto samples = static_cast<Eigen::Index>(header.samples);
  block.parameters.resize(shape.parameters, samples);
  block.responses.resize(shape.rows, samples);
  pieces.read(block.parameters.data(), block.parameters.size() * sizeof(double));
  pieces.read(block.responses.data(), block.responses.size() * sizeof(double));
  block.statuses = readStatuses(pieces, header.samples);
  if (pieces.getRemaining() != 0) {
    throw BadChunk("its sizes do not fit the file");
  }
  return block;
}

}  // namespace twinmap
