#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "framework/base/text/source_location.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "tests/framework/models/fmu/fmu_case.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap::testing {
namespace {

namespace fs = std::filesystem;

/// Everything that a process writes goes below a folder of its own here.
class Archive : public ::testing::Test {
 protected:
  void SetUp() override { setenv("TMPDIR", (folder_ / "tmp").c_str(), 1); }
  void TearDown() override { unsetenv("TMPDIR"); }

  /// What opening the FMU, and its library, throws.
  std::string open(const std::string& name) {
    fs::create_directories(folder_ / "tmp");
    try {
      const fmi::Package package(findFmu(name));
      simulate({name, fmi::Kind::kCoSimulation, {}, {}, {}, {"x"}, Eigen::VectorXd::Ones(1), 1.0, {}});
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  std::size_t countLeftovers() const {
    return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder_.getPath()),
                                                  fs::recursive_directory_iterator()));
  }

  TestFolder folder_;
};

TEST_F(Archive, WhatIsNoFmuIsRefusedWithTheReason) {
  const std::pair<const char*, const char*> kCases[] = {
      {"not_a_zip", "not a ZIP archive"},
      {"no_description", "has no modelDescription.xml"},
      {"broken_xml", "is not XML"},
      {"fmi_1", "only FMI 2.0 and 3.0"},
      {"other_platform", "there are: win64"},
      {"no_library", "cannot be loaded"},
      {"missing_function", "has no function fmi2SetReal"},
      {"wrong_token_2", "wrong GUID"},
      {"wrong_token_3", "wrong instantiation token"},
      {"broken_source", "do not compile"},
      {"not_there", "cannot be opened"},
  };
  for (const auto& [name, reason] : kCases) {
    EXPECT_NE(open(name).find(reason), std::string::npos) << name << ": " << open(name);
  }
  EXPECT_EQ(countLeftovers(), 1U);  // tmp itself
}

TEST_F(Archive, WhatLeadsOutOfItsFolderIsRefusedAndNothingIsWritten) {
  for (const char* name : {"traversal", "backslashes", "absolute", "link"}) {
    EXPECT_NE(open(name).find("would lead out"), std::string::npos) << name << ": " << open(name);
  }
  EXPECT_EQ(countLeftovers(), 1U);
  EXPECT_FALSE(fs::exists("/tmp/twinmap-escaped.txt"));
}

TEST_F(Archive, TheFolderGoesWithThePackage) {
  fs::create_directories(folder_ / "tmp");
  fs::path folder;
  {
    const fmi::Package package(findFmu("two_beam_2"));
    folder = package.getFolder();
    EXPECT_TRUE(fs::exists(folder / "modelDescription.xml"));
  }
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(Archive, AKindThatTheFmuLacksIsRefused) {
  fs::create_directories(folder_ / "tmp");
  const fmi::Package package(findFmu("two_beam_2"));
  EXPECT_EQ(package.chooseKind({}), fmi::Kind::kCoSimulation);
  EXPECT_EQ(package.chooseKind(fmi::Kind::kModelExchange), fmi::Kind::kModelExchange);
}

}  // namespace
}  // namespace twinmap::testing
