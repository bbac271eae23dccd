#include "framework/report/tables.hpp"

#include <gtest/gtest.h>

#include "framework/report/escape.hpp"
#include "framework/report/html_report.hpp"
#include "framework/report/stddev_figure.hpp"

namespace twinmap {
namespace {

RunSummary makeRun() {
  RunSummary run;
  run.name = "<script>alert(1)</script>";
  run.description = "\"quotes\" & more";
  run.parameters.resize(2);
  run.parameters[0].name = {"k_y", {}};
  run.parameters[0].unit = "N/m";
  run.parameters[0].bounds = {5, 15, {}};
  run.parameters[1].name = {"d", {}};
  run.parameters[1].unit = "a,b|c<i>";
  run.parameters[1].bounds = {1.75e-4, 2.25e-4, {}};
  run.axes = {0, 1};
  run.train_samples = 10;
  run.test_samples = 3;
  run.test_indices = {0, 2};
  run.truth = (Eigen::MatrixXd(2, 2) << 6, 12, 1.8e-4, 2.1e-4).finished();
  run.predictions.mean = run.truth * 1.5;
  run.predictions.stddev = (Eigen::MatrixXd(2, 2) << 0.1, 0.2, 1e-6, 3e-6).finished();
  run.metrics = calcMetrics(run.parameters, run.truth, run.predictions);
  run.nlml = {-100.5, 3};
  run.failures = {{"test", 1, Eigen::Vector2d(7, 2e-4), "step limit, \"t\" = 1"}};
  run.times = {{"simulate", 1.25}};
  return run;
}

TEST(Tables, MetricsCsvBeginsWithThePapersColumns) {
  const std::string csv = makeMetricsCsv(makeRun());
  EXPECT_EQ(csv.rfind("parameter,unit,lower,upper,bias_pct,sd_pct,mare_pct,coverage95,", 0), 0u);
  EXPECT_NE(csv.find("\nk_y,N/m,5,15,"), std::string::npos);
  EXPECT_NE(csv.find("\nd,\"a,b|c<i>\",0.000175,0.000225,"), std::string::npos);
}

TEST(Tables, PredictionsKeepTheSamplesIndices) {
  const std::string csv = makePredictionsCsv(makeRun());
  EXPECT_EQ(csv.rfind("sample,parameter,true,inferred,stddev\n0,k_y,6,9,0.1\n0,d,", 0), 0u);
  EXPECT_NE(csv.find("\n2,k_y,12,"), std::string::npos);
  EXPECT_EQ(csv.find("\n1,"), std::string::npos);
}

TEST(Tables, FailuresCarryTheirValuesAndReason) {
  EXPECT_EQ(makeFailuresCsv(makeRun()),
            "set,sample,k_y,d,reason\ntest,1,7,2e-04,\"step limit, \"\"t\"\" = 1\"\n");
}

TEST(Tables, MarkdownAndLatexEscapeAndAlign) {
  const std::string markdown = makeMarkdownTable(makeRun());
  EXPECT_EQ(
      markdown,
      "| parameter | unit         |    lower |    upper |  bias % |   sd % |  MARE % | coverage 95 % |\n"
      "|-----------|--------------|---------:|---------:|--------:|-------:|--------:|--------------:|\n"
      "| k_y       | N/m          |        5 |       15 | 50.0000 | 0.0000 | 50.0000 |         0.000 |\n"
      "| d         | a,b\\|c&lt;i> | 0.000175 | 0.000225 | 50.0000 | 0.0000 | 50.0000 |         0.000 |\n");
  const std::string latex = makeLatexTable(makeRun());
  EXPECT_NE(latex.find("k\\_y & N/m & 5 & 15 & 50.0000"), std::string::npos);
  EXPECT_NE(latex.find("bias \\% &"), std::string::npos);
  EXPECT_NE(latex.find("\\bottomrule"), std::string::npos);
}

TEST(Tables, EscapesLatexSpecials) {
  EXPECT_EQ(escapeLatex("50% of $a_b^c & {x} #1 ~ \\"),
            "50\\% of \\$a\\_b\\textasciicircum{}c \\& \\{x\\} \\#1 \\textasciitilde{} \\textbackslash{}");
}

TEST(HtmlReport, EscapesTextsAndShowsEveryPart) {
  const std::string html = makeHtmlReport(makeRun());
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<i>"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;alert(1)"), std::string::npos);
  EXPECT_NE(html.find("1 could not be simulated"), std::string::npos);
  EXPECT_NE(html.find("step limit, &quot;t&quot;"), std::string::npos);
  EXPECT_NE(html.find("Inferred standard deviation of k_y"), std::string::npos);
}

TEST(StddevFigure, DrawsAPointPerTestSampleAtItsPlace) {
  const std::string svg = makeStddevFigure(makeRun(), 0);
  std::size_t points = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    ++points;
  }
  EXPECT_EQ(points, 2u);
  // k_y = 6 of 5 ... 15 is a tenth along the axis from 62 to 352, and the least sd is viridis' darkest.
  EXPECT_NE(svg.find("cx=\"91.0\""), std::string::npos);
  EXPECT_NE(svg.find("fill=\"#440154\""), std::string::npos);
  EXPECT_NE(svg.find("fill=\"#fde725\""), std::string::npos);
}

}  // namespace
}  // namespace twinmap
