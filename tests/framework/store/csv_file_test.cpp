#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/text/csv.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

TEST(CsvFile, ReadsQuotesCommasAndLineBreaksInCells) {
  const CsvTable table = parseCsv("name,value\n\"a,\"\"b\"\"\nc\",1.5\r\nplain,\n", "x.csv");
  EXPECT_EQ(table.columns, (std::vector<std::string>{"name", "value"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.getText(0, "name"), "a,\"b\"\nc");
  EXPECT_EQ(table.getNumber(0, "value"), 1.5);
  EXPECT_TRUE(std::isnan(table.getNumber(1, "value")));
}

TEST(CsvFile, AMissingColumnReadsAsNothing) {
  const CsvTable table = parseCsv("a\n1\n", "x.csv");
  EXPECT_FALSE(table.hasColumn("b"));
  EXPECT_EQ(table.getText(0, "b"), "");
  EXPECT_TRUE(std::isnan(table.getNumber(0, "b")));
}

TEST(CsvFile, AMissingFileHasNoColumnsAndAHeaderAloneNoRows) {
  EXPECT_TRUE(readCsvFile("/no/such/file.csv").columns.empty());
  const CsvTable header = parseCsv("a,b\n", "x.csv");
  EXPECT_EQ(header.columns.size(), 2u);
  EXPECT_TRUE(header.empty());
}

TEST(CsvFile, DamagedFilesAreNamedWithTheirLine) {
  const auto message = [](const std::string& text) {
    try {
      parseCsv(text, "x.csv");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("a,b\n1,2\n3\n"), "x.csv:3: has 1 cells, but the header has 2");
  EXPECT_EQ(message("a\n\"open\n"), "x.csv:2: has a quote that is not closed");
  EXPECT_EQ(message("a\n\"b\"c\n"), "x.csv:2: has text after a quoted cell");
}

}  // namespace
}  // namespace twinmap
