#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/diagnosis/held_out.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap::cli {
namespace {

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

std::string makeValidationTable(const std::vector<Validated>& all, const std::vector<OutputSpec>& outputs) {
  std::vector<std::vector<std::string>> rows{{"predicted", "rms (noise sd)", "nominal", "p", ""}};
  for (const OutputSpec& output : outputs) {
    rows.front().push_back(output.name.text);
  }
  for (const Validated& one : all) {
    const HeldOutPrediction& prediction = one.prediction;
    rows.push_back({one.source, toShortText(prediction.rms, kFigures),
                    toShortText(prediction.nominal_rms, kFigures),
                    prediction.p_value < 1e-4 ? "< 0.0001" : toShortText(prediction.p_value, 2),
                    one.is_good ? "passed" : "failed"});
    for (const double rms : prediction.output_rms) {
      rows.back().push_back(std::isfinite(rms) ? toShortText(rms, kFigures) : "-");
    }
  }
  return alignRows(rows, 1);
}

std::string makeValidationJson(const std::vector<Validated>& all, const std::vector<OutputSpec>& outputs) {
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
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      const double rms = prediction.output_rms[static_cast<Eigen::Index>(o)];
      row["outputs"][outputs[o].name.text] = std::isfinite(rms) ? Json(rms) : Json(nullptr);
    }
    json["predictions"].push_back(row);
  }
  return formatJson(json);
}

}  // namespace

void validate(const ValidateArguments& arguments) {
  setThreads(arguments.threads);
  WaitingLine waiting(fmt::format("validate {}", fmt::join(arguments.files, ", ")));
  const InferenceSource source(arguments.run);
  const MeasurementReader& reader = source.getReader();
  const std::vector<KnownValue> known = parseKnownValues(arguments.known);
  const RecordedFeatures fitted = readRecordings(reader, arguments.files, arguments.starts, known);
  const SimulatorPosteriorOptions options =
      makePosteriorOptions(reader.getExperiment(), SimulatorPosteriorOptions{}.draws);
  const ExperimentSpec experiment = sizeNoiseByFit(reader.getExperiment(), fitted, options);
  const KnownMachine machine = inferMachine(experiment, fitted, options);
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
  const std::vector<OutputSpec>& outputs = reader.getExperiment().model.outputs;
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
