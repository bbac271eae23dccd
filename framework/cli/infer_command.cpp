#include <fmt/core.h>
#include <malloc.h>

#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "framework/cli/commands.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/direct_inference.hpp"
#include "framework/inference/inference_text.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement_session.hpp"
#include "framework/inference/measurement_stream.hpp"

namespace twinmap::cli {
namespace {

enum class Format { kTable, kCsv, kJson };

Format chooseFormat(const InferArguments& arguments) {
  return arguments.json || arguments.follow ? Format::kJson : arguments.csv ? Format::kCsv : Format::kTable;
}

/// An inference as it is written: for the format asked for, and its posterior's draws as CSV.
struct WrittenInference {
  std::string text, draws;
};

/// What measurements are inferred by: a trained run, or an experiment alone.
class InferenceSource {
 public:
  virtual ~InferenceSource() = default;
  virtual std::vector<std::string> listColumns() const = 0;
  virtual double getStart(std::optional<double> start) const = 0;
  virtual std::string makeCsvHeader() const = 0;
  virtual std::string makeDrawsHeader() const = 0;
  virtual WrittenInference infer(const Table& table, std::optional<double> start, Format format) = 0;
};

class RunSource final : public InferenceSource {
 public:
  explicit RunSource(const InferArguments& arguments)
      : inferrer_(arguments.run),
        known_(collectKnown(inferrer_.getExperiment().model.inputs, parseKnownValues(arguments.known))),
        session_(inferrer_, arguments.refine, arguments.posterior_draws) {}

  std::vector<std::string> listColumns() const override { return inferrer_.getReader().listColumns(); }
  double getStart(std::optional<double> start) const override { return session_.getStart(start); }
  std::string makeCsvHeader() const override {
    return makeInferenceCsvHeader(session_.refines(), session_.samplesPosteriors());
  }
  std::string makeDrawsHeader() const override {
    return makeDrawsCsvHeader(collectUnknown(inferrer_.getExperiment().model));
  }

  WrittenInference infer(const Table& table, std::optional<double> start, Format format) override {
    const InferredMeasurement inferred = session_.infer(table, start, known_);
    const std::vector<ParameterSpec>& parameters = inferrer_.getExperiment().model.parameters;
    const std::vector<FeatureInfo>& features = inferrer_.getExtractor().getInfos();
    const std::string draws = session_.samplesPosteriors() ? makeDrawsCsvRows(inferred) : "";
    switch (format) {
      case Format::kTable:
        return {makeInferenceTable(inferred, parameters, features), draws};
      case Format::kCsv:
        return {makeInferenceCsvRows(inferred, parameters), draws};
      case Format::kJson:
        return {makeInferenceJson(inferred, parameters, features) + "\n", draws};
    }
    return {};
  }

 private:
  Inferrer inferrer_;
  Eigen::VectorXd known_;
  MeasurementSession session_;
};

class ExperimentSource final : public InferenceSource {
 public:
  explicit ExperimentSource(const InferArguments& arguments)
      : inferrer_(
            readExperimentWithSignals(loadExperimentTree(arguments.run)),
            arguments.posterior_draws > 0 ? arguments.posterior_draws : SimulatorPosteriorOptions{}.draws),
        known_(collectKnown(getModel().inputs, parseKnownValues(arguments.known))) {}

  std::vector<std::string> listColumns() const override { return inferrer_.getReader().listColumns(); }
  double getStart(std::optional<double> start) const override {
    return inferrer_.getReader().getStart(start);
  }
  std::string makeCsvHeader() const override { return makeInferenceCsvHeader(false, false); }
  std::string makeDrawsHeader() const override { return makeDirectDrawsHeader(collectUnknown(getModel())); }

  WrittenInference infer(const Table& table, std::optional<double> start, Format format) override {
    const DirectInference inferred = inferrer_.infer(table, start, known_);
    const std::vector<ParameterSpec>& parameters = inferrer_.getParameters();
    const std::string draws = makeDirectDrawsRows(inferred);
    switch (format) {
      case Format::kTable:
        return {makeDirectTable(inferred, parameters, inferrer_.getReader().getExtractor().getInfos()),
                draws};
      case Format::kCsv:
        return {makeDirectCsvRows(inferred, parameters), draws};
      case Format::kJson:
        return {makeDirectJson(inferred, parameters) + "\n", draws};
    }
    return {};
  }

 private:
  const ModelSpec& getModel() const { return inferrer_.getReader().getExperiment().model; }

  DirectInferrer inferrer_;
  Eigen::VectorXd known_;
};

/// An experiment's file; anything else is a run.
bool isExperimentFile(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

std::unique_ptr<InferenceSource> makeSource(const InferArguments& arguments) {
  if (!isExperimentFile(arguments.run)) {
    return std::make_unique<RunSource>(arguments);
  }
  if (arguments.refine) {
    throw ExperimentError(
        "an experiment file is inferred by simulation alone: there is nothing to refine; leave "
        "--refine and --no-refine out, or give the folder of a run");
  }
  return std::make_unique<ExperimentSource>(arguments);
}

/// Infers one measurement after another and prints what comes out. A measurement that cannot be used is an
/// error of its own.
class InferCommand {
 public:
  explicit InferCommand(const InferArguments& arguments)
      : source_(makeSource(arguments)),
        format_(chooseFormat(arguments)),
        starts_(arguments.starts.begin(), arguments.starts.end()) {
    if (starts_.empty()) {
      starts_.emplace_back(std::nullopt);
    }
    if (format_ == Format::kCsv) {
      std::cout << source_->makeCsvHeader();
    }
    if (!arguments.draws.empty()) {
      draws_file_ = arguments.draws;
      draws_.emplace(draws_file_);
      *draws_ << source_->makeDrawsHeader();
      requireDraws();
    }
  }

  void inferFile(const std::string& file) {
    try {
      inferTable(readTable(file, source_->listColumns()));
    } catch (const std::exception& error) {
      reportError(file, source_->getStart(starts_.front()), error.what());
    }
  }

  void inferStream(std::istream& stream) {
    MeasurementStream measurements(stream);
    std::string text;
    for (int i = 1; measurements.next(text); ++i) {
      const std::string source = "measurement " + std::to_string(i);
      try {
        std::istringstream table(text);
        inferTable(readCsv(table, source, source_->listColumns()));
      } catch (const std::exception& error) {
        reportError(source, source_->getStart(starts_.front()), error.what());
      }
      std::cout.flush();
    }
  }

  /// Throws std::runtime_error if a measurement could not be used.
  void finish() {
    std::cout.flush();
    if (draws_) {
      draws_->flush();
      requireDraws();
    }
    if (errors_ > 0) {
      throw std::runtime_error(fmt::format("{} of {} measurements could not be used", errors_, count_));
    }
  }

 private:
  void inferTable(const Table& table) {
    for (const std::optional<double>& start : starts_) {
      try {
        print(source_->infer(table, start, format_));
        ++count_;
      } catch (const std::exception& error) {
        reportError(table.source, source_->getStart(start), error.what());
      }
    }
  }

  void requireDraws() const {
    if (!*draws_) {
      throw std::runtime_error(draws_file_ + ": cannot be written");
    }
  }

  void print(const WrittenInference& inferred) {
    if (draws_) {
      *draws_ << inferred.draws;
    }
    std::cout << (count_ > 0 && format_ == Format::kTable ? "\n" : "") << inferred.text;
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

  std::unique_ptr<InferenceSource> source_;
  Format format_;
  std::vector<std::optional<double>> starts_;
  std::string draws_file_;
  std::optional<std::ofstream> draws_;
  int count_ = 0, errors_ = 0;
};

/// The arrays of a map are read, packed and freed: to give each back to the system, and to get the next one
/// from it, takes a page fault for each 4 kB, a sixth of the time of one inference.
void keepFreedMemory() {
  constexpr int kMegabyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 64 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 256 * kMegabyte);
  mallopt(M_TOP_PAD, 16 * kMegabyte);
}

}  // namespace

void infer(const InferArguments& arguments) {
  keepFreedMemory();
  if (!arguments.trials.empty() || arguments.joint || arguments.windows) {
    inferJointly(arguments);
    return;
  }
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
