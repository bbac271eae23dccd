#include "framework/store/chunk_file.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>

namespace twinmap {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

ChunkShape makeShape() {
  const std::string content = "model";
  return {calcDigest(content.data(), content.size()), 2, 3};
}

/// Three samples, the second of which failed.
SampleBlock makeBlock() {
  SampleBlock block;
  block.parameters.resize(2, 3);
  block.parameters << 1, 2, 3, -0.0, 1e-300, 5;
  block.responses.resize(3, 3);
  block.responses << 1, kNan, 7, 2, kNan, 8, 3, kNan, 9;
  block.statuses = {{true, ""}, {false, "step limit"}, {true, ""}};
  return block;
}

bool haveSameBits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Why the bytes are not used, or "".
std::string findFault(const std::string& bytes, const ChunkShape& shape = makeShape()) {
  try {
    readChunk(bytes, shape);
  } catch (const BadChunk& bad) {
    return bad.what();
  }
  return "";
}

std::string withChecksum(std::string bytes) {
  const Digest digest = calcDigest(bytes.data(), bytes.size());
  return bytes.append(reinterpret_cast<const char*>(digest.data()), digest.size());
}

template <class T>
T get(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(ChunkFile, ReadsBackEveryBit) {
  const SampleBlock block = makeBlock(), read = readChunk(makeChunk(block, makeShape()), makeShape());
  EXPECT_TRUE(haveSameBits(read.parameters, block.parameters));
  EXPECT_TRUE(haveSameBits(read.responses, block.responses));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(read.statuses[i].ok, block.statuses[i].ok);
    EXPECT_EQ(read.statuses[i].reason, block.statuses[i].reason);
  }
}

// The layout of docs/reference/files.md, byte by byte.
TEST(ChunkFile, IsLaidOutAsDocumented) {
  const std::string bytes = makeChunk(makeBlock(), makeShape());
  ASSERT_EQ(bytes.size(), 56u + 8 * 6 + 8 * 9 + 8 * 3 + 10 + 16);
  EXPECT_EQ(bytes.substr(0, 8), "twmchunk");
  EXPECT_EQ(get<std::uint64_t>(bytes, 8), 1u);
  EXPECT_EQ(get<Digest>(bytes, 16), makeShape().content);
  EXPECT_EQ(get<std::uint64_t>(bytes, 32), 2u);
  EXPECT_EQ(get<std::uint64_t>(bytes, 40), 3u);
  EXPECT_EQ(get<std::uint64_t>(bytes, 48), 3u);
  EXPECT_EQ(get<double>(bytes, 56 + 8 * 2), 2.0);          // second sample, first parameter
  EXPECT_EQ(get<double>(bytes, 56 + 8 * 6 + 8 * 7), 8.0);  // third sample, second row
  EXPECT_EQ(get<std::uint32_t>(bytes, 176 + 8), 0u);       // second sample failed
  EXPECT_EQ(get<std::uint32_t>(bytes, 176 + 8 + 4), 10u);  // with a reason of ten bytes
  EXPECT_EQ(bytes.substr(200, 10), "step limit");
  EXPECT_EQ(withChecksum(bytes.substr(0, 210)), bytes);
  EXPECT_EQ(calcChunkSize(makeShape(), 3), bytes.size() - 10);
}

TEST(ChunkFile, FindsEveryFlippedBit) {
  const std::string bytes = makeChunk(makeBlock(), makeShape());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    EXPECT_NE(findFault(flipped), "") << bit;
  }
}

TEST(ChunkFile, FindsEveryTruncationAndWhatWasAppended) {
  const std::string bytes = makeChunk(makeBlock(), makeShape());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(findFault(bytes.substr(0, size)), "") << size;
  }
  EXPECT_NE(findFault(bytes + '\0'), "");
  EXPECT_NE(findFault(bytes + bytes), "");
}

RC_GTEST_PROP(ChunkFile, FindsDamagedStretches, ()) {
  const std::string bytes = makeChunk(makeBlock(), makeShape());
  std::string damaged = bytes;
  const std::size_t first = *rc::gen::inRange<std::size_t>(0, bytes.size());
  const std::size_t size = *rc::gen::inRange<std::size_t>(1, bytes.size() - first + 1);
  for (std::size_t i = first; i < first + size; ++i) {
    damaged[i] = *rc::gen::arbitrary<char>();
  }
  RC_PRE(damaged != bytes);
  RC_ASSERT(findFault(damaged) != "");
}

TEST(ChunkFile, RefusesSamplesOfAnotherModelOrShape) {
  const std::string bytes = makeChunk(makeBlock(), makeShape());
  ChunkShape other = makeShape();
  other.content[0] ^= 1;
  EXPECT_EQ(findFault(bytes, other).rfind("it holds samples of another model", 0), 0u);
  other = makeShape();
  other.rows = 9;
  EXPECT_EQ(findFault(bytes, other), "it has another number of parameters or rows");
}

TEST(ChunkFile, SizesThatDoNotFitAreFoundEvenWithARightChecksum) {
  const std::string bytes = makeChunk(makeBlock(), makeShape());
  for (const std::uint64_t samples :
       {std::uint64_t{0}, std::uint64_t{2}, std::uint64_t{4}, ~std::uint64_t{0}}) {
    std::string forged = bytes.substr(0, bytes.size() - sizeof(Digest));
    std::memcpy(forged.data() + 48, &samples, sizeof samples);
    EXPECT_EQ(findFault(withChecksum(forged)), "its sizes do not fit the file") << samples;
  }
}

TEST(ChunkFile, AnUndamagedChunkOfALaterVersionIsAnError) {
  std::string later = makeChunk(makeBlock(), makeShape());
  later.resize(later.size() - sizeof(Digest));
  later[8] = 2;
  try {
    readChunk(withChecksum(later), makeShape());
    FAIL();
  } catch (const BadChunk&) {
    FAIL() << "would be set aside";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "is a chunk of format version 2; this program reads version 1");
  }
}

// The value that xxHash publishes for no bytes.
TEST(Digest, IsXxh3OfTheCanonicalForm) {
  EXPECT_EQ(toHex(calcDigest("", 0)), "99aa06d3014798d86001c324468d497f");
}

}  // namespace
}  // namespace twinmap
