#include "framework/report/sections/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "framework/base/log/notice.hpp"
#include "framework/report/sections/verdict.hpp"
#include "tests/framework/report/run_fixture.hpp"

namespace twinmap {
namespace {

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

nlohmann::json readPageData(const std::string& html) {
  const std::string begin = "id=\"page-data\">";
  const std::size_t start = html.find(begin) + begin.size();
  return nlohmann::json::parse(html.substr(start, html.find("</script>", start) - start));
}

class ReportTest : public testing::Test {
 protected:
  TestFolder folder_;

  Report make(const std::string& more_yaml = "") {
    writeRunFolder(folder_ / "run", more_yaml);
    return makeReport({folder_ / "run"});
  }
};

TEST_F(ReportTest, NoTextOfTheExperimentBecomesMarkup) {
  const std::string html = make().html;
  EXPECT_EQ(count(html, "alert(1)</script>"), 0);
  EXPECT_EQ(count(html, "<script>alert"), 0);
  EXPECT_EQ(count(html, "<script"), 5);  // the data, three libraries, the page's own
  EXPECT_EQ(count(html, "</script>"), 5);
  EXPECT_EQ(count(html, "<!--"), 0);
  EXPECT_NE(
      html.find("&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt; &quot;q&quot; &#39;a&#39; &amp; 50%"),
      std::string::npos);
}

TEST_F(ReportTest, BeginsWithTheMechanismAndStaysSmall) {
  const std::string html = make().html;
  const std::size_t picture = html.find("<figure id=\"mechanism\"><svg"), end = html.find("</svg>", picture);
  ASSERT_NE(picture, std::string::npos);
  EXPECT_LT(picture, html.find("<section"));
  EXPECT_LT(end - picture, 60000U);
  EXPECT_NE(html.find("twinmap view RUN"), std::string::npos);
  EXPECT_LT(html.size(), 2000000U);
}

TEST_F(ReportTest, TextsInFiguresReadBackAsTheyWere) {
  const nlohmann::json data = readPageData(make().html);
  EXPECT_EQ(data["tables"]["failures"]["reason"][0], kHostile);
}

TEST_F(ReportTest, TheTableCarriesExactValuesAndShowsThemRounded) {
  const std::string html = make().html;
  EXPECT_NE(html.find("data-value=\"0.0749123\" class=\"number\">0.0749(24)"), std::string::npos);
}

TEST_F(ReportTest, CopiesOfTheTableAreEscapedForTheirFormat) {
  const nlohmann::json texts = readPageData(make().html)["texts"];
  EXPECT_EQ(texts["metrics-csv"], readFile(folder_ / "run" / "metrics.csv"));
  EXPECT_NE(texts["metrics-markdown"].get<std::string>().find(
                "| k         | N/m   |    80 |   120 |  0.125 | 0.0749(24) |"),
            std::string::npos);
  const std::string latex = texts["metrics-latex"];
  EXPECT_NE(latex.find("bias \\% & sd \\%"), std::string::npos);
  EXPECT_NE(latex.find("k & N/m & 80 & 120 & 0.125 & 0.0749(24) &"), std::string::npos);
}

TEST_F(ReportTest, SamplesTableHoldsErrorsAndScores) {
  const nlohmann::json samples = readPageData(make().html)["tables"]["samples"];
  EXPECT_EQ(samples["sample"], (std::vector<int>{0, 2}));
  EXPECT_EQ(samples["error_k"], (std::vector<double>{1, -1}));
  EXPECT_EQ(samples["z_d"], (std::vector<double>{1, -2}));
  EXPECT_NEAR(samples["pit_d"][0], 0.8413447461, 1e-7);
  EXPECT_NEAR(samples["pit_d"][1], 0.0227501319, 1e-7);
}

TEST_F(ReportTest, GatesAreListedAndAnswered) {
  const Report report =
      make("gates:\n  - {metric: coverage95, min: 0.9}\n  - {metric: sd_pct, parameter: k, max: 0.1}\n");
  ASSERT_EQ(report.gates.size(), 2u);
  EXPECT_FALSE(report.gates[0].passed);
  EXPECT_TRUE(report.gates[1].passed);
  EXPECT_NE(report.html.find("0.9 \u2264 coverage95, every parameter"), std::string::npos);
}

TEST_F(ReportTest, WarningsOfTheRunAreShown) {
  EXPECT_NE(make().html.find("1 sample could not be simulated"), std::string::npos);
}

TEST_F(ReportTest, ParametersStandBeforeBookKeeping) {
  const std::string html = make().html;
  const std::size_t table = html.find("id=\"errors-table\""), facts = html.find("class=\"facts\"");
  ASSERT_NE(table, std::string::npos);
  EXPECT_LT(html.find("id=\"verdict\""), table);
  EXPECT_LT(table, facts);
  EXPECT_EQ(html.find("acceptance criteria"), std::string::npos);  // none are set
}

TEST_F(ReportTest, WhatNeedsNothingIsARemark) {
  for (const Notice harmless : {Notice::kIntervalsTooWide, Notice::kRelativeToRange}) {
    const std::string text = describeNotice(harmless, "k");
    const std::string html = makeWarningList({text});
    EXPECT_TRUE(isRemark(text));
    EXPECT_EQ(html.find("warning"), std::string::npos) << html;
    EXPECT_NE(html.find("Remarks"), std::string::npos);
  }
  const std::string needed = describeNotice(Notice::kCorrelated, "k and m");
  EXPECT_FALSE(isRemark(needed));
  EXPECT_NE(makeWarningList({needed}).find("warning"), std::string::npos);
}

TEST_F(ReportTest, MissingFilesLeaveTheirChapterOut) {
  writeRunFolder(folder_ / "run");
  for (const char* name :
       {"predictions.csv", "training.csv", "failures.csv", "provenance.json", "metrics.csv"}) {
    std::filesystem::remove(folder_ / "run" / name);
    const std::string html = makeReport({folder_ / "run"}).html;
    EXPECT_NE(html.find("id=\"verdict\""), std::string::npos) << name;
  }
  const std::string html = makeReport({folder_ / "run"}).html;
  EXPECT_EQ(html.find("id=\"calibration\""), std::string::npos);
  EXPECT_EQ(html.find("id=\"metrics\""), std::string::npos);
}

TEST_F(ReportTest, AFolderWithoutARunAndDamagedFilesAreNamed) {
  EXPECT_THROW(makeReport({folder_ / "nothing"}), std::runtime_error);
  writeRunFolder(folder_ / "run");
  writeTextFile(folder_ / "run" / "provenance.json", "{\"date\": ");
  try {
    makeReport({folder_ / "run"});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("provenance.json"), std::string::npos);
  }
}

TEST_F(ReportTest, WritesThePageAndEachFiguresData) {
  writeReport(folder_ / "out", make());
  EXPECT_EQ(readFile(folder_ / "out" / "report.html").rfind("<!DOCTYPE html>", 0), 0u);
  const std::string samples = readFile(folder_ / "out" / "figures" / "samples.csv");
  EXPECT_EQ(samples.rfind("sample,true_k,inferred_k,stddev_k,error_k,z_k,pit_k,true_d,", 0), 0u);
  EXPECT_NE(samples.find("\n2,90,89,1,-1,-1,"), std::string::npos);
}

TEST_F(ReportTest, SeveralRunsStandSideBySide) {
  writeRunFolder(folder_ / "a");
  writeRunFolder(folder_ / "b");
  const std::string html = makeReport({folder_ / "a", folder_ / "b"}).html;
  EXPECT_NE(html.find("2 runs side by side"), std::string::npos);
  EXPECT_EQ(readPageData(html)["tables"]["comparison"]["run"],
            (std::vector<std::string>{"a", "a", "b", "b"}));
}

}  // namespace
}  // namespace twinmap
