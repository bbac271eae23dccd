#include "framework/base/hdf5/hdf5_file.hpp"

#include <gtest/gtest.h>

#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

void writeExample(const std::filesystem::path& path) {
  Hdf5Writer file(path);
  const std::vector<double> cube{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  file.write("/cube", cube.data(), {2, 3, 2});
  file.writeSamples("/group/samples", (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished());
  file.write("/group/vector", Eigen::VectorXd(Eigen::Vector3d(1, 2, 3)));
  file.write("/group/number", 2.5);
  file.write("/integers", std::vector<std::int64_t>{-1, 5});
  file.write("/no_integers", std::vector<std::int64_t>{});
  file.write("/texts", std::vector<std::string>{"y", "", "theta \xce\xb8"});
  file.writeAttribute("/", "format", "test 1");
  file.writeAttribute("/group", "empty", "");
  file.close();
}

TEST(Hdf5File, ReadsBackWhatWasWritten) {
  const TestFolder folder;
  writeExample(folder / "a.h5");
  const Hdf5Reader file(folder / "a.h5");
  EXPECT_EQ(file.readShape("/cube"), (std::vector<std::size_t>{2, 3, 2}));
  EXPECT_EQ(file.readSamples("/cube").col(1), (Eigen::VectorXd(6) << 6, 7, 8, 9, 10, 11).finished());
  EXPECT_EQ(file.readShape("/group/samples"), (std::vector<std::size_t>{3, 2}));
  EXPECT_EQ(file.readSamples("/group/samples"), (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished());
  EXPECT_EQ(file.readVector("/group/vector"), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.readNumber("/group/number"), 2.5);
  EXPECT_EQ(file.readIntegers("/integers"), (std::vector<std::int64_t>{-1, 5}));
  EXPECT_TRUE(file.readIntegers("/no_integers").empty());
  EXPECT_EQ(file.readTexts("/texts"), (std::vector<std::string>{"y", "", "theta \xce\xb8"}));
  EXPECT_EQ(file.readAttribute("/", "format"), "test 1");
  EXPECT_EQ(file.readAttribute("/group", "empty"), "");
}

TEST(Hdf5File, EqualContentGivesEqualBytes) {
  const TestFolder folder;
  writeExample(folder / "a.h5");
  sleep(1);  // a time stamp would differ
  writeExample(folder / "b.h5");
  EXPECT_EQ(readFile(folder / "a.h5"), readFile(folder / "b.h5"));
}

TEST(Hdf5File, ErrorsNameFileAndDataset) {
  const TestFolder folder;
  writeExample(folder / "a.h5");
  const Hdf5Reader file(folder / "a.h5");
  try {
    file.readVector("/nothing");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a.h5: has no dataset /nothing"), std::string::npos);
  }
  EXPECT_THROW(Hdf5Reader(folder / "b.h5"), std::runtime_error);
  EXPECT_THROW(Hdf5Writer(folder / "no/b.h5"), std::runtime_error);
}

}  // namespace
}  // namespace twinmap
