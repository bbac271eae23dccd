#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "framework/base/json/json.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/diagnosis/held_out.hpp"
#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap::cli {
namespace {

using Eigen::VectorXd;

constexpr int kFigures = 3;

/// A prediction and whether it passes.
struct Validated {
  std::string source;
  HeldOutPrediction prediction;
  bool is_good = false;
};

bool isGood(const HeldOutPrediction& prediction, const std::optional<double>& max_rms) {
  constexpr double kLevel = 0.01;  // of good predictions, so many fail
  return prediction.rms < prediction.nominal_rms &&
         (max_rms ? prediction.rms <= *max_rms : prediction.p_value >= kLevel);
}

std::string makeValidationTable(const std::vector<Validated>& all, const ResponseLayout& outputs) {
  std::vector<std::vector<std::string>> rows{{"predicted", "rms (noise sd)", "nominal", "p", ""}};
  for (std::size_t o = 0; o < outputs.output_names.size(); ++o) {
    rows.front().push_back(outputs.output_names[o]);
    rows.front().push_back(fmt::format("({})", outputs.output_units[o]));
  }
  for (const Validated& one : all) {
    const HeldOutPrediction& prediction = one.prediction;
    rows.push_back({one.source, toShortText(prediction.rms, kFigures),
                    toShortText(prediction.nominal_rms, kFigures),
                    prediction.p_value < 1e-4 ? "< 0.0001" : toShortText(prediction.p_value, 2),
                    one.is_good ? "passed" : "failed"});
    for (std::size_t o = 0; o < outputs.output_names.size(); ++o) {
      for (const VectorXd* rms : {&prediction.output_rms, &prediction.unit_rms}) {
        const double own = (*rms)[static_cast<Eigen::Index>(o)];
        rows.back().push_back(std::isfinite(own) ? toShortText(own, kFigures) : "-");
      }
    }
  }
  return alignRows(rows, 1);
}

std::string makeValidationJson(const std::vector<Validated>& all, const ResponseLayout& outputs) {
  Json json{{"predictions", Json::array()}};
  for (const Validated& one : all) {
    const HeldOutPrediction& prediction = one.prediction;
    Json row{{"source", one.source},
             {"rms", prediction.rms},
             {"nominal_rms", prediction.nominal_rms},
             {"chi_square", prediction.chi_square},
             {"degrees", prediction.degrees},
             {"p_value", prediction.p_value},
             {"passed", one.is_good}};
    for (std::size_t o = 0; o < outputs.output_names.size(); ++o) {
      const double rms = prediction.output_rms[static_cast<Eigen::Index>(o)];
      row["outputs"][outputs.output_names[o]] = std::isfinite(rms) ? Json(rms) : Json(nullptr);
      if (const double own = prediction.unit_rms[static_cast<Eigen::Index>(o)]; std::isfinite(own)) {
        row["rms_in_units"][outputs.output_names[o]] = own;
      }
    }
    json["predictions"].push_back(row);
  }
  return formatJson(json);
}

VectorXd collectStated(const std::vector<ParameterSpec>& parameters, const std::vector<KnownValue>& stated) {
  const std::vector<std::string> names = collectNames(parameters);
  VectorXd values = VectorXd::Constant(static_cast<Eigen::Index>(parameters.size()), std::nan(""));
  for (const KnownValue& one : stated) {
    const auto found = std::find(names.begin(), names.end(), one.name);
    if (found == names.end()) {
      throw ExperimentError("--with: '" + one.name + "' is not a parameter of this experiment" +
                            suggestName(one.name, names));
    }
    values[found - names.begin()] = one.value;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::isnan(values[static_cast<Eigen::Index>(i)])) {
      throw ExperimentError("--with: the parameter '" + names[i] + "' is not stated; state all of them");
    }
  }
  return values;
}

/// Of the parameters that are stated or, without them, of those inferred from `fitted`.
KnownMachine findMachine(const ExperimentSpec& experiment, const ValidateArguments& arguments,
                         const RecordedFeatures& fitted, const SimulatorPosteriorOptions& options) {
  return arguments.stated.empty()
             ? inferMachine(experiment, fitted, options)
             : stateMachine(experiment, collectStated(experiment.model.parameters,
                                                      parseKnownValues(arguments.stated, "--with")));
}

void requireFiles(const ValidateArguments& arguments, const ExperimentSpec& experiment) {
  if (!arguments.files.empty()) {
    return;
  }
  if (arguments.stated.empty()) {
    throw ExperimentError(
        "validate: give files to infer the parameters from, or state them: --with NAME=VALUE,...");
  }
  if (hasUnknownNoise(experiment.noise)) {
    throw ExperimentError("validate: the size of the noise is unknown; give files to find it from");
  }
}

}  // namespace

void validate(const ValidateArguments& arguments) {
  setThreads(arguments.threads);
  WaitingLine waiting(fmt::format("validate {}", fmt::join(arguments.files, ", ")));
  const InferenceSource source(arguments.run);
  const MeasurementReader& reader = source.getReader();
  const std::vector<KnownValue> known = parseKnownValues(arguments.known);
  requireFiles(arguments, reader.getExperiment());
  const RecordedFeatures fitted = readRecordings(reader, arguments.files, arguments.starts, known);
  const SimulatorPosteriorOptions options =
      makePosteriorOptions(reader.getExperiment(), SimulatorPosteriorOptions{}.draws);
  const ExperimentSpec experiment = sizeNoiseByFit(reader.getExperiment(), fitted, options);
  const KnownMachine machine = findMachine(experiment, arguments, fitted, options);
  std::vector<Validated> all;
  for (const std::string& file : arguments.against) {
    const RecordedFeatures windows = readRecordings(reader, {file}, arguments.against_starts, known);
    for (std::size_t k = 0; k < windows.features.size(); ++k) {
      Validated one;
      one.source = windows.features.size() == 1
                       ? file
                       : fmt::format("{} from {} s", file, toText(arguments.against_starts[k]));
      const SearchStage stage("predict " + one.source);
      one.prediction = predictHeldOut(experiment, windows.select({k}), machine);
      one.is_good = isGood(one.prediction, arguments.max_rms);
      all.push_back(one);
    }
  }
  waiting.clear();
  const ResponseLayout& outputs = reader.getLayout();
  std::cout << (arguments.json ? makeValidationJson(all, outputs) + "\n" : makeValidationTable(all, outputs));
  std::cout.flush();
  const auto failed =
      std::count_if(all.begin(), all.end(), [](const Validated& one) { return !one.is_good; });
  if (failed > 0) {
    throw GatesFailed(fmt::format(
        "{} of {} recordings are predicted worse than {}", failed, all.size(),
        arguments.max_rms ? fmt::format("{} noise sd, or than nominally", toText(*arguments.max_rms))
                          : "noise and the parameters' sd allow, or than nominally"));
  }
}

}  // namespace twinmap::cli
