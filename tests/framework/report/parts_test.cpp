#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/text/base64.hpp"
#include "framework/report/data_table.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sweep_groups.hpp"

namespace twinmap {
namespace {

TEST(DataTable, CsvKeepsAllDigitsAndJsonRoundsThem) {
  DataTable table;
  table.add("x", std::vector<double>{0.123456789012, 3.0, NAN});
  table.add("name", std::vector<std::string>{"a,b", "</script>", ""});
  EXPECT_EQ(table.toCsv(), "x,name\n0.123456789012,\"a,b\"\n3,</script>\n,\n");
  EXPECT_EQ(table.toJson().dump(), R"({"x":[0.1234568,3,null],"name":["a,b","</script>",""]})");
}

TEST(Html, CellsShowDashesForMissingNumbers) {
  EXPECT_EQ(makeNumberCell("").shown, "\u2013");
  EXPECT_EQ(makeNumberCell("nan").shown, "\u2013");
  EXPECT_EQ(makeNumberCell("0.123456").shown, "0.1235");
  EXPECT_EQ(makeNumberCell("0.123456", 3, "0.0123").shown, "0.123(12)");
}

TEST(Base64, MatchesTheTestVectorsOfRfc4648) {
  const auto encode = [](const std::string& text) {
    return encodeBase64(std::vector<unsigned char>(text.begin(), text.end()));
  };
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foo"), "Zm9v");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

TEST(SweepGroups, AverageOverSeedsAndKeepTheirSpread) {
  const CsvTable sweep = parseCsv(
      "case,design.train.samples,inverse_map.gp.covariance,seed,parameter,sd_pct,coverage95,limit_pct\n"
      "c1,50,matern52,1,k,2,0.9,1\nc2,50,matern52,2,k,4,1,1\nc3,100,matern52,1,k,1,0.95,1\nc4,100,matern52,2,"
      "k,,,\n",
      "sweep.csv");
  EXPECT_EQ(findVariedKeys(sweep),
            (std::vector<std::string>{"design.train.samples", "inverse_map.gp.covariance", "seed"}));
  const std::vector<SweepGroup> groups = groupCases(sweep);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].variant, "covariance=matern52");
  EXPECT_EQ(groups[0].size, 50);
  EXPECT_TRUE(std::isnan(groups[0].noise));
  EXPECT_EQ(groups[0].seeds, 2);
  EXPECT_EQ(groups[0].mean, 3);
  EXPECT_EQ(groups[0].lowest, 2);
  EXPECT_EQ(groups[0].highest, 4);
  EXPECT_EQ(groups[0].coverage, 0.95);
  EXPECT_EQ(groups[1].seeds, 1);  // the failed case is left out
}

}  // namespace
}  // namespace twinmap
