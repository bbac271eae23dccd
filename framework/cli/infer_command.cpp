#include <fmt/format.h>

#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "framework/cli/commands.hpp"
#include "framework/inference/inference_text.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement_stream.hpp"
#include "framework/inference/refiner.hpp"

namespace twinmap::cli {
namespace {

enum class Format { kTable, kCsv, kJson };

Format chooseFormat(const InferArguments& arguments) {
  return arguments.json || arguments.follow ? Format::kJson : arguments.csv ? Format::kCsv : Format::kTable;
}

/// Infers one measurement after another and prints what comes out. A measurement that cannot be used is an
/// error of its own.
class InferCommand {
 public:
  explicit InferCommand(const InferArguments& arguments)
      : inferrer_(arguments.run),
        format_(chooseFormat(arguments)),
        starts_(arguments.starts.begin(), arguments.starts.end()),
        known_(collectKnown(inferrer_.getExperiment().model.inputs, parseKnownValues(arguments.known))),
        workspace_(inferrer_) {
    if (starts_.empty()) {
      starts_.emplace_back(std::nullopt);
    }
    if (arguments.refine.value_or(inferrer_.getExperiment().refine != RefineMode::kNever)) {
      refiner_.emplace(inferrer_.getExperiment(), inferrer_.getLayout());
      if (!arguments.refine && !refiner_->isWanted()) {
        refiner_.reset();
      }
    }
    if (format_ == Format::kCsv) {
      std::cout << makeInferenceCsvHeader(refiner_.has_value());
    }
  }

  void inferFile(const std::string& file) {
    try {
      inferTable(readTable(file, inferrer_.listColumns()), file);
    } catch (const std::exception& error) {
      reportError(file, getStart(starts_.front()), error.what());
    }
  }

  void inferStream(std::istream& stream) {
    MeasurementStream measurements(stream);
    std::string text;
    for (int i = 1; measurements.next(text); ++i) {
      const std::string source = "measurement " + std::to_string(i);
      try {
        std::istringstream table(text);
        inferTable(readCsv(table, source, inferrer_.listColumns()), source);
      } catch (const std::exception& error) {
        reportError(source, getStart(starts_.front()), error.what());
      }
      std::cout.flush();
    }
  }

  /// Throws std::runtime_error if a measurement could not be used.
  void finish() const {
    std::cout.flush();
    if (errors_ > 0) {
      throw std::runtime_error(fmt::format("{} of {} measurements could not be used", errors_, count_));
    }
  }

 private:
  double getStart(const std::optional<double>& start) const {
    return start.value_or(inferrer_.getExperiment().measurement.start);
  }

  void inferTable(const Table& table, const std::string& source) {
    for (const std::optional<double>& start : starts_) {
      try {
        print(infer(table, source, start));
        ++count_;
      } catch (const std::exception& error) {
        reportError(source, getStart(start), error.what());
      }
    }
  }

  InferredMeasurement infer(const Table& table, const std::string& source,
                            const std::optional<double>& start) {
    inferrer_.requireExcitation(table, start);
    const Eigen::VectorXd features = inferrer_.extractFeatures(inferrer_.readResponse(table, start), source);
    InferredMeasurement inferred = inferrer_.infer(features, known_, workspace_);
    inferred.source = source;
    inferred.start = getStart(start);
    if (refiner_) {
      const std::optional<TrustModel>& trust = inferrer_.getTrustModel();
      refiner_->refineAndJudge(features, known_, trust ? &*trust : nullptr, inferred);
    }
    return inferred;
  }

  void print(const InferredMeasurement& inferred) {
    const std::vector<ParameterSpec>& parameters = inferrer_.getExperiment().model.parameters;
    const std::vector<FeatureInfo>& features = inferrer_.getExtractor().getInfos();
    switch (format_) {
      case Format::kTable:
        std::cout << (count_ > 0 ? "\n" : "") << makeInferenceTable(inferred, parameters, features);
        break;
      case Format::kCsv:
        std::cout << makeInferenceCsvRows(inferred, parameters);
        break;
      case Format::kJson:
        std::cout << makeInferenceJson(inferred, parameters, features) << '\n';
        break;
    }
  }

  void reportError(const std::string& source, double start, const std::string& error) {
    ++errors_;
    ++count_;
    if (format_ == Format::kJson) {
      std::cout << makeErrorJson(source, start, error) << '\n';
    }
    std::cout.flush();
    std::cerr << "twinmap: error: " << error << "\n";
  }

  Inferrer inferrer_;
  Format format_;
  std::vector<std::optional<double>> starts_;
  Eigen::VectorXd known_;
  Inferrer::Workspace workspace_;
  std::optional<SimulatorRefiner> refiner_;
  int count_ = 0, errors_ = 0;
};

}  // namespace

void infer(const InferArguments& arguments) {
  if (arguments.follow == !arguments.files.empty()) {
    throw ExperimentError(arguments.follow
                              ? "--follow reads measurements from the standard input; give no files"
                              : "give files of measurements, or --follow");
  }
  std::ios::sync_with_stdio(false);
  InferCommand command(arguments);
  if (arguments.follow) {
    command.inferStream(std::cin);
  }
  for (const std::string& file : arguments.files) {
    command.inferFile(file);
  }
  command.finish();
}

}  // namespace twinmap::cli
