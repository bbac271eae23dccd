// How right inference without a run is on a mechanism:
//   posterior_study FILE.yaml [tests] [draws] [seed] [reference=DRAWS] [NAME=VALUE ...]
// simulates measurements of machines drawn from the bounds (with the parameters named held at their values),
// infers each as `infer FILE.yaml m.csv` does and prints what the statuses were, how often the intervals
// hold, the errors against the information limit, simulation-based calibration, the combinations that were
// named, how far mean and sd are from those of as many draws as `reference` says, and last a row of the table
// in docs/benchmarks/posterior.md.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bench/framework/estimation/posterior_bench.hpp"
#include "framework/analysis/rank_calibration.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double calcMedian(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

/// Counts over measurements, and medians of what they cost.
struct Totals {
  std::map<std::string, int> statuses, ridges;
  int reliable = 0, ok = 0, missed = 0, wrong = 0;
  int unmeasured = 0;  ///< machines that could not be simulated
  std::vector<double> seconds, simulations, sizes;
};

Totals count(const std::vector<Judged>& judged) {
  Totals totals;
  for (const Judged& one : judged) {
    ++totals.statuses[one.status];
    ++totals.ridges[one.ridges];
    totals.reliable += one.reliable;
    totals.ok += one.ok;
    totals.missed += one.missed;
    totals.wrong += one.ok && one.z.cwiseAbs().maxCoeff() > 6.0;
    totals.seconds.push_back(one.seconds);
    totals.simulations.push_back(one.simulations);
    totals.sizes.push_back(one.size);
  }
  return totals;
}

void printTotals(const Totals& totals) {
  fmt::print(
      "  {} measurements ({} machines could not be simulated), {} with a reliable posterior; best basin "
      "missed "
      "{}, ok and more than 6 sd off {}\n"
      "  median {:.3f} s of a processor (largest {:.2f}), {:.0f} simulations, effective sample size {:.0f}\n",
      totals.seconds.size(), totals.unmeasured, totals.reliable, totals.missed, totals.wrong,
      calcMedian(totals.seconds), *std::max_element(totals.seconds.begin(), totals.seconds.end()),
      calcMedian(totals.simulations), calcMedian(totals.sizes));
  for (const auto& [status, number] : totals.statuses) {
    fmt::print("  {:5d} {}\n", number, status);
  }
  for (const auto& [ridges, number] : totals.ridges) {
    if (!ridges.empty()) {
      fmt::print("  {:5d} name {}\n", number, ridges);
    }
  }
}

/// Of reliable posteriors, p each; ratio: of the errors to the information limit; expected: of the
/// posteriors' standard deviations to it, which is what the errors' would be of infinitely many tests if
/// these are right.
struct Figures {
  VectorXd coverage95, coverage50, ratio, expected, worst;
  VectorXd uniformity;  ///< p + 1, of the ranks; the last of all together
};

Figures summarize(const std::vector<Judged>& judged, Index p) {
  Figures figures{VectorXd::Zero(p), VectorXd::Zero(p), {}, {}, VectorXd::Zero(p), {}};
  VectorXd errors = VectorXd::Zero(p), variances = VectorXd::Zero(p), limits = VectorXd::Zero(p);
  Eigen::MatrixXi ranks(p + 1, static_cast<Index>(judged.size()));
  Index n = 0;
  for (const Judged& one : judged) {
    if (one.reliable) {
      figures.coverage95 += one.held95;
      figures.coverage50 += one.held50;
      figures.worst = figures.worst.cwiseMax(one.z.cwiseAbs());
      errors += one.error.cwiseAbs2();
      variances += one.stddev.cwiseAbs2();
      limits += one.limit.cwiseAbs2();
      ranks.col(n++) = one.ranks;
    }
  }
  figures.coverage95 /= static_cast<double>(n);
  figures.coverage50 /= static_cast<double>(n);
  figures.ratio = errors.cwiseQuotient(limits).cwiseSqrt();
  figures.expected = variances.cwiseQuotient(limits).cwiseSqrt();
  figures.uniformity = n >= kMinRanks ? calcRankCalibration(ranks.leftCols(n)).p_value
                                      : VectorXd::Constant(p + 1, std::nan(""));
  return figures;
}

void printFigures(const Figures& figures, const std::vector<ParameterSpec>& parameters) {
  const auto p = static_cast<Index>(parameters.size());
  for (Index j = 0; j < p; ++j) {
    fmt::print(
        "  {:>10}  coverage95 {:.3f}  coverage50 {:.3f}  ratio {:.3f} (expected {:.3f})  worst z {:.1f}  SBC "
        "p "
        "{:.3f}\n",
        parameters[static_cast<std::size_t>(j)].name.text, figures.coverage95[j], figures.coverage50[j],
        figures.ratio[j], figures.expected[j], figures.worst[j], figures.uniformity[j]);
  }
  fmt::print("  {:>10}  SBC p {:.3f}\n", "together", figures.uniformity[p]);
}

std::string makeRange(const VectorXd& values) {
  const double least = values.minCoeff(), most = values.maxCoeff();
  return fmt::format("{:.2f}", least) == fmt::format("{:.2f}", most)
             ? fmt::format("{:.2f}", most)
             : fmt::format("{:.2f} - {:.2f}", least, most);
}

/// The mechanism is called by its file, or by its folder where the file is called as all others are.
std::string findName(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  return stem == "experiment" || stem == "best" ? file.parent_path().filename().string() : stem;
}

void printRow(const StudyRequest& request, const Totals& totals, const Figures& figures) {
  std::string name = findName(request.file);
  for (const auto& [parameter, value] : request.held) {
    name += fmt::format(", {} = {}", parameter, value);
  }
  const auto tests = static_cast<double>(totals.seconds.size());
  fmt::print("| {} | {:.0f} | {} | {} | {} | {:.1f} | {:.3f} | {:.2f} s | {:.1f} % |\n", name, tests,
             makeRange(figures.coverage95), makeRange(figures.coverage50), makeRange(figures.ratio),
             figures.worst.maxCoeff(), figures.uniformity.minCoeff(), calcMedian(totals.seconds),
             100.0 * totals.ok / tests);
}

/// What the errors of all measurements have in common, their mean, and how far they scatter about it.
std::string describeErrors(const Eigen::ArrayXd& errors, double unit) {
  return fmt::format("{:+.2f} +- {:.2f}", unit * errors.mean(),
                     unit * std::sqrt((errors - errors.mean()).square().mean()));
}

/// What is left to chance by the number of draws: errors against many more of them.
void printDrawErrors(const std::vector<Judged>& judged, const std::vector<ParameterSpec>& parameters) {
  constexpr double kPercent = 100.0;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    std::vector<double> means, stddevs;
    for (const Judged& one : judged) {
      if (one.mean_error.size() > 0) {
        means.push_back(one.mean_error[static_cast<Index>(j)]);
        stddevs.push_back(one.stddev_error[static_cast<Index>(j)]);
      }
    }
    const auto count = static_cast<Index>(means.size());
    fmt::print("  {:>10}  by draws: mean off by {} % of sd, sd by {} %\n", parameters[j].name.text,
               describeErrors(Eigen::Map<Eigen::ArrayXd>(means.data(), count), kPercent),
               describeErrors(Eigen::Map<Eigen::ArrayXd>(stddevs.data(), count), kPercent));
  }
}

StudyRequest readRequest(int argc, char** argv) {
  StudyRequest request;
  int position = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    if (const std::size_t equals = text.find('='); equals != std::string::npos) {
      const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
      if (name == "reference") {
        request.reference = std::stoi(value);
      } else {
        request.held[name] = std::stod(value);
      }
      continue;
    }
    switch (position++) {
      case 0:
        request.file = text;
        break;
      case 1:
        request.tests = std::stoi(text);
        break;
      case 2:
        request.draws = std::stoi(text);
        break;
      default:
        request.seed = std::stoull(text);
    }
  }
  return request;
}

int run(const StudyRequest& request) {
  const PosteriorBench bench(request);
  std::vector<Judged> judged;
  int unmeasured = 0;
  for (int test = 0; test < request.tests; ++test) {
    std::string failure;
    const std::optional<Measured> measured = bench.measure(test, failure);
    if (!measured) {
      ++unmeasured;
      fmt::print("    {}: not simulated: {}\n", test, failure);
    } else {
      judged.push_back(bench.judge(*measured, test));
      const Judged& last = judged.back();
      if (!last.reliable || last.missed || last.z.cwiseAbs().maxCoeff() > 4.0) {
        fmt::print("    {}: {}\n", test, last.describe());
      }
    }
  }
  fmt::print("{}\n", request.file);
  if (judged.empty()) {
    fmt::print("  none of {} machines could be simulated\n", unmeasured);
    return 0;
  }
  Totals totals = count(judged);
  totals.unmeasured = unmeasured;
  printTotals(totals);
  if (totals.reliable > 0) {
    const Figures figures = summarize(judged, static_cast<Index>(bench.getParameters().size()));
    printFigures(figures, bench.getParameters());
    if (request.reference > 0) {
      printDrawErrors(judged, bench.getParameters());
    }
    printRow(request, totals, figures);
  }
  return 0;
}

}  // namespace
}  // namespace twinmap

int main(int argc, char** argv) {
  const twinmap::StudyRequest request = twinmap::readRequest(argc, argv);
  if (request.file.empty()) {
    fmt::print(
        stderr,
        "usage: posterior_study FILE.yaml [tests] [draws] [seed] [reference=DRAWS] [NAME=VALUE ...]\n");
    return 2;
  }
  return twinmap::run(request);
}
