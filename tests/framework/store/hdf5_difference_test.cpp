#include "framework/store/hdf5_difference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"

namespace twinmap {
namespace {

using Write = std::function<void(Hdf5Writer&)>;

std::string findBetween(const Write& write, const Write& write_expected) {
  const TemporaryFolder folder;
  for (const auto& [name, fill] : {std::pair("a.h5", write), {"b.h5", write_expected}}) {
    Hdf5Writer file(folder.getPath() / name);
    fill(file);
    file.close();
  }
  return findHdf5Difference(folder.getPath() / "a.h5", folder.getPath() / "b.h5");
}

Write makeFile(double last = 6.0, std::int64_t integer = 1, const std::string& text = "m",
               const std::string& attribute = "one") {
  return [=](Hdf5Writer& file) {
    file.writeSamples("/set/values", (Eigen::MatrixXd(3, 2) << 1, 4, 2, 5, 3, last).finished());
    file.write("/set/ok", std::vector<std::int64_t>{7, integer});
    file.write("/unit", std::vector<std::string>{"N", text});
    file.write("/number", 1.0);
    file.writeAttribute("/", "format", attribute);
  };
}

TEST(Hdf5Difference, NamesTheFirstElementAndBothValues) {
  EXPECT_EQ(findBetween(makeFile(), makeFile()), "");
  EXPECT_EQ(findBetween(makeFile(6.5), makeFile()), "/set/values[1, 2]: 6.5 instead of 6");
  EXPECT_EQ(findBetween(makeFile(6, 0), makeFile()), "/set/ok[1]: 0 instead of 1");
  EXPECT_EQ(findBetween(makeFile(6, 1, "s"), makeFile()), "/unit[1]: 's' instead of 'm'");
}

TEST(Hdf5Difference, ComparesBitsNotNumbers) {
  EXPECT_EQ(findBetween(makeFile(-0.0), makeFile(0.0)), "/set/values[1, 2]: -0 instead of 0");
  EXPECT_EQ(findBetween(makeFile(std::nan("")), makeFile(std::nan(""))), "");
}

TEST(Hdf5Difference, NamesDatasetsThatOneFileLacksOrThatHaveAnotherShape) {
  const Write more = [](Hdf5Writer& file) {
    makeFile()(file);
    file.write("/set/more", 1.0);
  };
  EXPECT_EQ(findBetween(more, makeFile()), "/set/more: should not be there");
  EXPECT_EQ(findBetween(makeFile(), more), "/set/more: is missing");
  const auto shaped = [](int n) {
    return [n](Hdf5Writer& file) { file.write("/x", Eigen::VectorXd(Eigen::VectorXd::Ones(n))); };
  };
  EXPECT_EQ(findBetween(shaped(2), shaped(3)), "/x: has another shape or type");
}

TEST(Hdf5Difference, SeesWhatIsNoData) {
  EXPECT_NE(findBetween(makeFile(6, 1, "m", "two"), makeFile()).find("all data are equal, but byte"),
            std::string::npos);
}

}  // namespace
}  // namespace twinmap
