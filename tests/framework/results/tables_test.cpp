#include "framework/results/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_with_error.hpp"
#include "framework/experiment/gate_spec.hpp"
#include "framework/store/predictions_file.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

RunSummary makeRun() {
  RunSummary run;
  run.parameters.resize(2);
  run.parameters[0].name = {"k_y", {}};
  run.parameters[0].unit = "N/m";
  run.parameters[0].bounds = {5, 15, {}};
  run.parameters[1].name = {"d", {}};
  run.parameters[1].unit = "a,b|c<i>";
  run.parameters[1].bounds = {1.75e-4, 2.25e-4, {}};
  run.test_indices = {0, 2};
  run.evaluation.truth = (Eigen::MatrixXd(2, 2) << 6, 12, 1.8e-4, 2.1e-4).finished();
  run.evaluation.predictions.mean = run.evaluation.truth * 1.5;
  run.evaluation.predictions.stddev = (Eigen::MatrixXd(2, 2) << 0.1, 0.2, 1e-6, 3e-6).finished();
  run.evaluation.metrics = calcMetrics(run.parameters, run.evaluation.truth, run.evaluation.predictions);
  run.evaluation.pit_counts = {{2, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 2}};
  run.training.nlml = {-100.5, 3};
  run.failures = {{"test", 1, Eigen::Vector2d(7, 2e-4), "step limit, \"t\" = 1"}};
  run.notes.times = {{"simulate", 1.25}};
  return run;
}

TEST(Tables, GatesMayHoldEveryMetricAndNoOther) {
  RunSummary run = makeRun();
  run.evaluation.limit_stddev = run.evaluation.predictions.stddev;
  std::string header = makeMetricsCsv(run);
  header = header.substr(0, header.find('\n'));
  const std::vector<std::string> metrics = listGateMetrics();
  for (const std::string& metric : metrics) {
    EXPECT_NE((header + ",").find("," + metric + ","), std::string::npos) << metric;
  }
  std::istringstream columns(header.substr(std::string("parameter,unit,lower,upper,").size()));
  for (std::string column; std::getline(columns, column, ',');) {
    const bool is_error = column.size() > 3 && column.substr(column.size() - 3) == "_se";
    EXPECT_TRUE(is_error || std::count(metrics.begin(), metrics.end(), column) == 1) << column;
  }
}

TEST(Tables, SayWhatInferSays) {
  RunSummary run = makeRun();
  EXPECT_EQ(makeMarkdownTable(run).find("infer"), std::string::npos);
  run.evaluation.refined.resize(2);
  run.evaluation.answers = AnswerSummary{
      {{"posterior", {"multimodal", "outliers"}}, {"refined", {"ok"}}, {"refined", {"at_bounds"}}},
      Eigen::Vector3d(2, 1, 0),
      2,
      1};
  const std::string text = makeMarkdownTable(run);
  EXPECT_NE(text.find("as by infer: 2 estimates; 1 of these were sampled and stand for all.\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Not ok by infer: 66.7 % of the test samples (multimodal 66.7 %, outliers 66.7 %).\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("errors are to the nearest"), std::string::npos);
  const std::string csv = makeMetricsCsv(run);
  EXPECT_EQ(csv.substr(csv.find('\n') - 7, 7), ",not_ok");
  EXPECT_NE(csv.find(",0.6666666666666666\n"), std::string::npos) << csv;
}

// What the file says of estimates that stand for others is what the tables were made of.
TEST(Tables, PredictionsAreReadWithWhatTheyStandFor) {
  RunSummary run = makeRun();
  Estimates& predictions = run.evaluation.predictions;
  predictions.mean.conservativeResize(2, 3);
  predictions.stddev.conservativeResize(2, 3);
  predictions.mean.col(2) << 5.5, 1.9e-4;
  predictions.stddev.col(2) << 0.3, 2e-6;
  predictions.weights = Eigen::Vector3d(2, 1, -1);
  predictions.repeated = {0};
  const TestFolder folder;
  writeTextFile(folder / "predictions.csv", makePredictionsCsv(run));
  const StoredPredictions stored = readPredictionsFile(folder / "predictions.csv", {"k_y", "d"});
  EXPECT_EQ(stored.samples, run.test_indices);
  EXPECT_EQ(stored.truth, run.evaluation.truth);
  EXPECT_EQ(stored.predictions.mean, predictions.mean);
  EXPECT_EQ(stored.predictions.weights, predictions.weights);
  EXPECT_EQ(stored.predictions.repeated, predictions.repeated);
}

TEST(Tables, MetricsCsvBeginsWithThePapersColumns) {
  const std::string csv = makeMetricsCsv(makeRun());
  EXPECT_EQ(csv.rfind("parameter,unit,lower,upper,bias_pct,sd_pct,mare_pct,coverage95,", 0), 0u);
  EXPECT_NE(csv.find("\nk_y,N/m,5,15,"), std::string::npos);
  EXPECT_NE(csv.find("\nd,\"a,b|c<i>\",0.000175,0.000225,"), std::string::npos);
}

std::vector<std::string> splitCsv(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    c == ',' ? (void)cells.emplace_back() : cells.back().push_back(c);
  }
  return cells;
}

/// The first parameter's cell of a column.
std::string getCell(const std::string& csv, const std::string& column) {
  const std::size_t end = csv.find('\n');
  const std::vector<std::string> header = splitCsv(csv.substr(0, end));
  const std::vector<std::string> row = splitCsv(csv.substr(end + 1, csv.find('\n', end + 1) - end - 1));
  EXPECT_EQ(header.size(), row.size());
  const auto found = std::find(header.begin(), header.end(), column);
  return found == header.end() ? "no such column" : row.at(found - header.begin());
}

TEST(Tables, MetricsCsvHasAnErrorBesideEveryFigure) {
  RunSummary run = makeRun();
  run.evaluation.metrics[0].crps_pct = 1.5;
  run.evaluation.metrics[0].se.crps_pct = 0.25;
  const std::string csv = makeMetricsCsv(run);
  EXPECT_EQ(getCell(csv, "crps_pct"), "1.5");
  EXPECT_EQ(getCell(csv, "crps_pct_se"), "0.25");
  EXPECT_EQ(getCell(csv, "nlml"), "-100.5");
  EXPECT_EQ(getCell(csv, "test_samples"), "2");
}

TEST(Tables, LeaveOneOutColumnsAreEmptyWithoutIt) {
  RunSummary run = makeRun();
  EXPECT_EQ(getCell(makeMetricsCsv(run), "loo_sd_pct"), "");
  EXPECT_EQ(getCell(makeMetricsCsv(run), "loo_nlpd_se"), "");
  run.training.leave_one_out = run.evaluation.metrics;
  run.training.leave_one_out[0].sd_pct = 3.5;
  run.training.leave_one_out[0].se.nlpd = 0.125;
  EXPECT_EQ(getCell(makeMetricsCsv(run), "loo_sd_pct"), "3.5");
  EXPECT_EQ(getCell(makeMetricsCsv(run), "loo_nlpd_se"), "0.125");
}

TEST(Tables, TheLimitHasColumnsOnlyWhereItIsKnown) {
  RunSummary run = makeRun();
  EXPECT_EQ(getCell(makeMetricsCsv(run), "limit_pct"), "no such column");
  EXPECT_EQ(makeMarkdownTable(run).find("limit"), std::string::npos);
  run.evaluation.limit_stddev = run.evaluation.predictions.stddev / 2;
  run.evaluation.metrics[0].limit_pct = 0.07;
  run.evaluation.metrics[0].ratio_to_limit = 1.043;
  run.evaluation.metrics[0].se.ratio_to_limit = 0.031;
  EXPECT_EQ(getCell(makeMetricsCsv(run), "limit_pct"), "0.07");
  EXPECT_EQ(getCell(makeMetricsCsv(run), "ratio_to_limit_se"), "0.031");
  EXPECT_NE(makePredictionsCsv(run).find("stddev,limit_stddev\n0,k_y,6,9,0.1,0.05\n"), std::string::npos);
  EXPECT_NE(makeMarkdownTable(run).find(" |  0.0700 | 1.043(31) |\n"), std::string::npos);
  EXPECT_NE(makeLatexTable(run).find("{llrrrrrrrr}"), std::string::npos);
}

TEST(Tables, JointAndPit) {
  RunSummary run = makeRun();
  run.evaluation.joint.coverage90 = 0.875;
  run.evaluation.joint.se.coverage90 = 0.25;
  EXPECT_EQ(makeJointCsv(run),
            "metric,value,se\ncoverage95,0,0\ncoverage90,0.875,0.25\ncoverage50,0,0\nnlpd,0,0\n");
  const std::string pit = makePitCsv(run);
  EXPECT_EQ(pit.rfind("parameter,bin_lower,bin_upper,count\nk_y,0,0.1,2\nk_y,0.1,0.2,0\n", 0), 0u);
  EXPECT_NE(pit.find("\nd,0.9,1,2\n"), std::string::npos);
}

TEST(NumberWithError, ShowsTwoDigitsOfTheError) {
  EXPECT_EQ(toTextWithError(0.93824, 0.0301, 4), "0.938(30)");
  EXPECT_EQ(toTextWithError(-0.00063, 0.000561, 4), "-0.00063(56)");
  EXPECT_EQ(toTextWithError(0.5, 0.0996, 4), "0.50(10)");
  EXPECT_EQ(toTextWithError(12.345, 1.24, 4), "12.3(1.2)");
  EXPECT_EQ(toTextWithError(12.345, 0.996, 4), "12.3(1.0)");
  EXPECT_EQ(toTextWithError(1234.5, 67.8, 4), "1234(68)");
  EXPECT_EQ(toTextWithError(1234.5, 678, 4), "1234(678)");
}

TEST(NumberWithError, ShowsTheValueAloneWithoutAnError) {
  EXPECT_EQ(toTextWithError(1.0, 0.0, 3), "1.000");
  EXPECT_EQ(toTextWithError(1.0, 1e-17, 3), "1.000");
  EXPECT_EQ(toTextWithError(1.0, std::nan(""), 3), "1.000");
  EXPECT_EQ(toTextWithError(std::nan(""), 0.1, 3), "nan");
}

TEST(Tables, PredictionsKeepTheSamplesIndices) {
  const std::string csv = makePredictionsCsv(makeRun());
  EXPECT_EQ(csv.rfind("sample,parameter,true,inferred,stddev\n0,k_y,6,9,0.1\n0,d,", 0), 0u);
  EXPECT_NE(csv.find("\n2,k_y,12,"), std::string::npos);
  EXPECT_EQ(csv.find("\n1,"), std::string::npos);
}

TEST(Tables, FailuresCarryTheirValuesAndReason) {
  EXPECT_EQ(makeFailuresCsv(makeRun().parameters, makeRun().failures),
            "set,sample,k_y,d,reason\ntest,1,7,2e-04,\"step limit, \"\"t\"\" = 1\"\n");
}

TEST(Tables, MarkdownAndLatexEscapeAndAlign) {
  const std::string markdown = makeMarkdownTable(makeRun());
  EXPECT_EQ(markdown,
            "| parameter | unit         |    lower |    upper |  bias % |   sd % |  MARE % | cov. 95 % |\n"
            "|-----------|--------------|---------:|---------:|--------:|-------:|--------:|----------:|\n"
            "| k_y       | N/m          |        5 |       15 | 50.0000 | 0.0000 | 50.0000 |     0.000 |\n"
            "| d         | a,b\\|c&lt;i> | 0.000175 | 0.000225 | 50.0000 | 0.0000 | 50.0000 |     0.000 |\n"
            "\n"
            "In parentheses: the Monte Carlo standard error of the last digits, 0.938(30) = 0.938 with error "
            "0.030.\n");
  const std::string latex = makeLatexTable(makeRun());
  EXPECT_NE(latex.find("k\\_y & N/m & 5 & 15 & 50.0000"), std::string::npos);
  EXPECT_NE(latex.find("bias \\% &"), std::string::npos);
  EXPECT_NE(latex.find("\\bottomrule"), std::string::npos);
}

TEST(Tables, EscapesLatexSpecials) {
  EXPECT_EQ(escapeLatex("50% of $a_b^c & {x} #1 ~ \\"),
            "50\\% of \\$a\\_b\\textasciicircum{}c \\& \\{x\\} \\#1 \\textasciitilde{} \\textbackslash{}");
}

}  // namespace
}  // namespace twinmap
