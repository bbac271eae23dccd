#include <fmt/core.h>

#include "framework/base/json/json.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/inference/direct_inference.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int kShownDigits = 6, kShownStddevDigits = 3;
constexpr double kProbabilities[] = {0.025, 0.16, 0.5, 0.84, 0.975};

/// u x kProbabilities.
MatrixXd calcQuantiles(const SimulatorPosterior& posterior) {
  VectorXd probabilities(std::size(kProbabilities));
  for (Index k = 0; k < probabilities.size(); ++k) {
    probabilities[k] = kProbabilities[k];
  }
  return posterior.calcQuantiles(probabilities);
}

std::string join(const std::vector<std::string>& texts, const char* separator) {
  std::string joined;
  for (const std::string& text : texts) {
    joined += (joined.empty() ? "" : separator) + text;
  }
  return joined;
}

/// What a mismatch shows itself by, and what to look at.
std::string describeMismatch(const DirectInference& inferred) {
  const ResidualTest& test = inferred.test;
  if (test.calcPValue() >= kMismatchLevel) {
    return "";
  }
  if (test.largest_p <= std::min(test.chi_square_p, test.whiteness_p)) {
    return fmt::format(
        "  No parameter values within the bounds fit {}: it is {:.3g} noise sd off. Is it a spike?\n",
        inferred.largest, std::abs(inferred.posterior.residual[test.largest]));
  }
  if (test.whiteness_p < test.chi_square_p) {
    return "  The residuals of neighbouring samples agree more than the stated noise allows: the noise is "
           "coloured, or "
           "the model lacks something small.\n";
  }
  return "  No parameter values within the bounds fit the measurement: look at the residuals (a sensor "
         "fault, a wrong "
         "trigger, larger noise, physics that the model lacks).\n";
}

std::string describeMissing(const DirectInference& inferred) {
  std::string text;
  for (const std::string& remark : inferred.remarks) {
    text += "  left out: " + remark + "\n";
  }
  return text;
}

std::string describeSearch(const SimulatorPosterior& posterior) {
  return fmt::format(
      "  sampled on the simulator: best fit found by {} of {} searches, {} draws worth {:.0f} independent "
      "ones, {} "
      "simulations\n",
      posterior.found_best, posterior.starts, posterior.weights.size(), posterior.effective_sample_size,
      posterior.simulations);
}

std::string describeModes(const SimulatorPosterior& posterior, const std::vector<ParameterSpec>& parameters) {
  if (posterior.modes.size() < 2) {
    return "";
  }
  std::string text = "  The measurement fits in separate places:\n";
  for (const PosteriorMode& mode : posterior.modes) {
    std::string values;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Index>(p);
      values += fmt::format("{}{} = {} +- {}", p == 0 ? "" : ", ", parameters[p].name.text,
                            toShortText(mode.mean[i], kShownDigits),
                            toShortText(mode.stddev[i], kShownStddevDigits));
    }
    text += fmt::format("    {:3.0f} %: {}\n", 100.0 * mode.weight, values);
  }
  return text;
}

std::string makeParameterTable(const SimulatorPosterior& posterior,
                               const std::vector<ParameterSpec>& parameters) {
  const MatrixXd quantiles = calcQuantiles(posterior);
  std::vector<std::vector<std::string>> rows{{"parameter", "unit", "mean", "sd", "95 % interval"}};
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    rows.push_back({parameters[p].name.text, parameters[p].unit, toShortText(posterior.mean[i], kShownDigits),
                    toShortText(posterior.stddev[i], kShownStddevDigits),
                    toShortText(quantiles(i, 0), kShownDigits) + " .. " +
                        toShortText(quantiles(i, quantiles.cols() - 1), kShownDigits)});
  }
  return alignRows(rows, rows.front().size(), "  ");
}

Json makeParametersJson(const SimulatorPosterior& posterior, const std::vector<ParameterSpec>& parameters) {
  const MatrixXd quantiles = calcQuantiles(posterior);
  Json json = Json::object();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    Json& estimate = json[parameters[p].name.text];
    estimate = {{"mean", posterior.mean[i]},
                {"sd", posterior.stddev[i]},
                {"lower", quantiles(i, 0)},
                {"upper", quantiles(i, quantiles.cols() - 1)},
                {"unit", parameters[p].unit}};
    for (Index k = 0; k < quantiles.cols(); ++k) {
      estimate["quantiles"].push_back({kProbabilities[k], quantiles(i, k)});
    }
  }
  return json;
}

Json makeModesJson(const SimulatorPosterior& posterior, const std::vector<ParameterSpec>& parameters) {
  Json modes = Json::array();
  for (const PosteriorMode& mode : posterior.modes) {
    Json values = Json::object();
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Index>(p);
      values[parameters[p].name.text] = {
          {"mean", mode.mean[i]}, {"sd", mode.stddev[i]}, {"unit", parameters[p].unit}};
    }
    modes.push_back({{"weight", mode.weight}, {"chi_square", mode.chi_square}, {"parameters", values}});
  }
  return modes;
}

Json makeCovarianceJson(const SimulatorPosterior& posterior, std::size_t count) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < count; ++j) {
      row.push_back(posterior.covariance(static_cast<Index>(i), static_cast<Index>(j)));
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string makeDirectTable(const DirectInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const SimulatorPosterior& posterior = inferred.posterior;
  const std::string statuses = join(listStatuses(inferred, parameters), ", ");
  if (!(posterior.degrees > 0.0)) {
    return fmt::format("{}: {} ({})\n", inferred.source, statuses, posterior.message);
  }
  std::string text =
      fmt::format("{}: {} (p = {:.2g}, chi-square {:.4g} of {:.4g} degrees of freedom)\n", inferred.source,
                  statuses, inferred.test.calcPValue(), posterior.chi_square, posterior.degrees);
  text += describeMismatch(inferred) + describeMissing(inferred);
  if (!posterior.isReliable()) {
    return text + fmt::format("  No estimate: {}. Give narrower bounds, or more draws (--posterior=2000).\n",
                              posterior.message);
  }
  return text + makeParameterTable(posterior, parameters) + describeModes(posterior, parameters) +
         describeSearch(posterior);
}

std::string makeDirectCsvRows(const DirectInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const SimulatorPosterior& posterior = inferred.posterior;
  const bool reliable = posterior.isReliable();
  const MatrixXd quantiles = reliable ? calcQuantiles(posterior) : MatrixXd();
  std::string text;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    const std::string numbers = reliable ? toText(posterior.mean[i]) + "," + toText(posterior.stddev[i]) +
                                               "," + toText(quantiles(i, 0)) + "," +
                                               toText(quantiles(i, quantiles.cols() - 1))
                                         : ",,,";
    text +=
        fmt::format("{},{},{},{},{},{},{},posterior\n", escapeCsv(inferred.source), toText(inferred.start),
                    escapeCsv(parameters[p].name.text), escapeCsv(parameters[p].unit), numbers,
                    join(listStatuses(inferred, parameters), " "), toText(inferred.test.calcPValue()));
  }
  return text;
}

std::string makeDirectJson(const DirectInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const SimulatorPosterior& posterior = inferred.posterior;
  const std::vector<std::string> statuses = listStatuses(inferred, parameters);
  Json json{{"source", inferred.source},
            {"start", inferred.start},
            {"status", statuses.front()},
            {"statuses", statuses},
            {"method", "posterior"}};
  if (!inferred.remarks.empty()) {
    json["left_out"] = {{"features", inferred.left_out}, {"remarks", inferred.remarks}};
  }
  if (posterior.isReliable()) {
    json["parameters"] = makeParametersJson(posterior, parameters);
    json["covariance"] = makeCovarianceJson(posterior, parameters.size());
    json["modes"] = makeModesJson(posterior, parameters);
  } else {
    json["message"] = posterior.message;
  }
  json["trust"] = {{"p_value", inferred.test.calcPValue()},
                   {"chi_square", posterior.chi_square},
                   {"degrees", posterior.degrees},
                   {"chi_square_p_value", inferred.test.chi_square_p},
                   {"whiteness_p_value", inferred.test.whiteness_p},
                   {"largest_p_value", inferred.test.largest_p}};
  json["posterior"] = {{"effective_sample_size", posterior.effective_sample_size},
                       {"pareto_shape", posterior.pareto_shape},
                       {"searches", posterior.starts},
                       {"found_best", posterior.found_best},
                       {"simulations", posterior.simulations}};
  return formatJson(json);
}

std::string makeDirectDrawsHeader(const std::vector<ParameterSpec>& unknown) {
  std::string text = "source,start,draw,weight";
  for (const ParameterSpec& parameter : unknown) {
    text += "," + escapeCsv(parameter.name.text);
  }
  return text + "\n";
}

std::string makeDirectDrawsRows(const DirectInference& inferred) {
  const SimulatorPosterior& posterior = inferred.posterior;
  std::string text;
  for (Index i = 0; i < posterior.draws.cols(); ++i) {
    text += fmt::format("{},{},{},{}", escapeCsv(inferred.source), toText(inferred.start), i,
                        toText(posterior.weights[i]));
    for (const double value : posterior.draws.col(i)) {
      text += "," + toText(value);
    }
    text += "\n";
  }
  return text;
}

}  // namespace twinmap
