#include <fmt/core.h>
#include <malloc.h>
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/commands/measurements/infer_history.hpp"
#include "framework/cli/commands/measurements/infer_options.hpp"
#include "framework/cli/commands/measurements/inferred_printer.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/joint/compared_windows.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/inference/measurement/measurement_stream.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/study/replay/inferred_page.hpp"

namespace twinmap::cli {
namespace {

/// A file that rows are added to, if it is wanted.
class RowsFile {
 public:
  /// path: "": not wanted. Throws std::runtime_error where it cannot be written.
  RowsFile(std::string path, const std::string& header) : path_(std::move(path)) {
    if (!path_.empty()) {
      stream_.open(path_);
      add(header);
      flush();
    }
  }

  bool isWanted() const { return !path_.empty(); }
  void add(const std::string& rows) { stream_ << rows; }
  /// Throws std::runtime_error where rows could not be written.
  void flush() {
    if (isWanted() && !stream_.flush()) {
      throw std::runtime_error(path_ + ": cannot be written");
    }
  }

 private:
  const std::string path_;
  std::ofstream stream_;
};

/// Infers one measurement after another and prints what comes out. A measurement that cannot be used is an
/// error of its own.
class InferCommand {
 public:
  explicit InferCommand(const InferArguments& arguments)
      : source_(arguments.run),
        session_(source_.makeSession(makeSessionOptions(arguments))),
        known_(collectKnown(getModel().inputs, parseKnownValues(arguments.known))),
        asked_{arguments.run, {}, {}, arguments.known, {}, arguments.posterior_draws},
        is_stream_(arguments.follow),
        tests_model_(!arguments.follow),
        diagnoses_(arguments.diagnose),
        printer_(chooseFormat(arguments), getModel().parameters, session_->refines(),
                 session_->samplesPosteriors()),
        history_(getModel().parameters),
        page_(arguments.page),
        starts_(arguments.starts.begin(), arguments.starts.end()),
        draws_(arguments.draws, makeDrawsCsvHeader(collectUnknown(getModel()))),
        profile_(arguments.profile, makeProfileCsvHeader(collectUnknown(getModel()))) {
    if (starts_.empty()) {
      starts_.emplace_back(std::nullopt);
    }
  }

  void printHeader() const { printer_.printHeader(); }

  void inferFile(const std::string& file) {
    try {
      inferTable(readTable(file, source_.getReader().listColumns(), session_->getMissingCells()));
    } catch (const std::exception& error) {
      reportError(file, source_.getReader().getStatedStart(starts_.front()), error.what());
    }
  }

  void inferStream(std::istream& stream) {
    MeasurementStream measurements(stream);
    std::string text;
    for (int i = 1; measurements.next(text); ++i) {
      const std::string source = "measurement " + std::to_string(i);
      try {
        std::istringstream table(text);
        inferTable(readCsv(table, source, source_.getReader().listColumns(), session_->getMissingCells()));
      } catch (const std::exception& error) {
        reportError(source, source_.getReader().getStatedStart(starts_.front()), error.what());
      }
      std::cout.flush();
    }
  }

  /// Throws std::runtime_error if a measurement could not be used.
  void finish() {
    printCourses();
    draws_.flush();
    profile_.flush();
    if (errors_ > 0) {
      throw std::runtime_error(count_ == 1
                                   ? "the measurement could not be used"
                                   : fmt::format("{} of {} measurements could not be used", errors_, count_));
    }
  }

 private:
  /// All its windows are inferred before any is printed: together they say whether they agree.
  void inferTable(const Table& table) {
    std::vector<InferredMeasurement> windows;
    std::vector<Window> others;  // what else there is of each
    for (const std::optional<double>& start : starts_) {
      Window window{start, {}, ""};
      InferredMeasurement inferred;
      try {
        inferred = inferWindow(table, window, windows);
      } catch (const std::exception& error) {
        window.error = error.what();
      }
      windows.push_back(std::move(inferred));
      others.push_back(std::move(window));
    }
    compareWindows(getModel().parameters, windows);
    for (std::size_t i = 0; i < windows.size(); ++i) {
      finishWindow(table, windows[i], others[i]);
    }
  }

  struct Window {
    std::optional<double> start;
    std::optional<RecordedFeatures> recording;  // to be diagnosed, after a misfit
    std::string error;                          // "" of none
  };

  void finishWindow(const Table& table, const InferredMeasurement& inferred, const Window& window) {
    if (!window.error.empty()) {
      reportError(table.source, source_.getReader().getStatedStart(window.start), window.error);
      return;
    }
    print(inferred, inferred.asked.diagnoses ? &*window.recording : nullptr);
    draw(table, inferred);
    ++count_;
  }

  /// At an interrupt.
  void printFinished(const InferredMeasurement& inferred) {
    if (!inferred.source.empty()) {  // else it could not be used
      printer_.print(inferred, source_.getReader().getExtractor().getInfos(), false);
    }
  }

  /// before: windows that are finished, which an interrupt prints, and this one's answer, once it is known.
  InferredMeasurement inferWindow(const Table& table, Window& window,
                                  const std::vector<InferredMeasurement>& before) {
    const std::optional<double>& start = window.start;
    const auto print_finished = [&] {
      for (const InferredMeasurement& one : before) {
        printFinished(one);
      }
    };
    WaitingLine waiting("infer " + nameWindow(table.source, start), print_finished);
    InferredMeasurement inferred = session_->infer(table, start, known_);
    inferred.asked = describeAsked(table.source, start);
    if (tests_model_) {
      waiting.describe("look for what the model lacks, " + nameWindow(table.source, start),
                       [&, answer = inferred] {
                         print_finished();
                         printFinished(answer);
                       });
      window.recording = testModel(source_.getReader(), table, start, known_, inferred);
    }
    inferred.asked.diagnoses = window.recording && diagnoses_;
    return inferred;
  }

  /// For the page, where one is wanted.
  void draw(const Table& table, const InferredMeasurement& inferred) {
    if (page_.empty() || drawn_.size() >= kMostDrawn) {
      return;
    }
    const MeasurementReader& reader = source_.getReader();
    DrawnMeasurement drawn{starts_.size() > 1 ? nameWindow(inferred.source, inferred.start)
                                              : inferred.source};
    try {
      ReplayOptions options;
      options.measurement = options.from = {inferred.source, inferred.start};
      options.known = known_;
      drawn.replay = replayInferred(source_, table, inferred, options);
    } catch (const std::exception& error) {
      drawn.text = makeInferenceTable(inferred, getModel().parameters, reader.getExtractor().getInfos()) +
                   "not drawn: " + error.what();
    }
    drawn_.push_back(std::move(drawn));
  }

  Asked describeAsked(const std::string& source, const std::optional<double>& start) const {
    Asked asked = asked_;
    if (!is_stream_) {
      asked.files = {source};
    }
    if (start) {
      asked.starts = {*start};
    }
    return asked;
  }

  void printCourses() const {
    if (!isTable() && page_.empty()) {
      return;
    }
    const History& history = history_.get();
    const std::optional<std::vector<Course>> courses = fitCourses(history);
    if (isTable() && courses) {
      std::cout << "\n" << describeCourses(history, courses);
    }
    std::cout.flush();
    if (!page_.empty()) {
      writeTextFile(page_, makeInferredPage(source_.getExperiment().name.text, source_.getReader(), drawn_,
                                            history, courses));
      std::cerr << "Page: " << page_ << "\n";
    }
  }

  bool isTable() const { return printer_.getFormat() == InferFormat::kTable; }
  const ModelSpec& getModel() const { return source_.getExperiment().model; }
  /// recording: to be diagnosed as well; null: not.
  void print(const InferredMeasurement& inferred, const RecordedFeatures* recording) {
    if (isTable() || !page_.empty()) {  // a stream has no end
      history_.add(inferred);
    }
    if (draws_.isWanted()) {
      draws_.add(makeDrawsCsvRows(inferred));
    }
    if (profile_.isWanted()) {
      profile_.add(makeProfileCsvRows(inferred, collectUnknown(getModel())));
    }
    printer_.print(inferred, source_.getReader().getExtractor().getInfos(), count_ == 0);
    if (recording != nullptr) {  // not of CSV
      std::cout << (isTable() ? "\n" + makeDiagnosisTable(diagnose(*recording), inferred.source)
                              : makeDiagnosisJson(diagnose(*recording), inferred.source) + "\n");
    }
  }

  Diagnosis diagnose(const RecordedFeatures& recording) const {
    DiagnosisOptions options;
    options.posterior = makePosteriorOptions(source_.getExperiment(), SimulatorPosteriorOptions{}.draws);
    return twinmap::diagnose(source_.getExperiment(), recording, options);
  }

  void reportError(const std::string& source, double start, const std::string& error) {
    ++errors_;
    ++count_;
    if (printer_.getFormat() == InferFormat::kJson) {
      std::cout << makeErrorJson(source, start, error) << '\n';
    }
    std::cout.flush();
    std::cerr << "twinmap: error: " << error << "\n";
  }

  const InferenceSource source_;
  const std::unique_ptr<MeasurementInference> session_;
  const Eigen::VectorXd known_;
  const Asked asked_;  // of each file
  const bool is_stream_, tests_model_, diagnoses_;
  const InferredPrinter printer_;
  InferHistory history_;
  const std::string page_;
  std::vector<DrawnMeasurement> drawn_;
  std::vector<std::optional<double>> starts_;
  RowsFile draws_, profile_;
  int count_ = 0, errors_ = 0;
};

/// The arrays of a map are read, packed and freed. To return each to the system, and to get the next one,
/// takes a page fault for each 4 kB. That is a third of the time of one inference. So freed memory is kept,
/// and comes in huge pages where the system has some.
void keepFreedMemory() {
  constexpr std::size_t kMegabyte = 1 << 20, kHugePage = 2 * kMegabyte, kSize = 24 * kMegabyte;
  mallopt(M_MMAP_THRESHOLD, 64 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 256 * kMegabyte);
  if (void* heap = std::malloc(kSize)) {
    const std::uintptr_t begin =
        (reinterpret_cast<std::uintptr_t>(heap) + kHugePage - 1) / kHugePage * kHugePage;
    madvise(reinterpret_cast<void*>(begin), kSize - kHugePage, MADV_HUGEPAGE);  // else as it was
    std::free(heap);
  }
}

/// --page draws estimates; whoever asks for a diagnosis as well expects that of the diagnosis.
void requireOnePage(const InferArguments& arguments) {
  if (arguments.diagnose && !arguments.page.empty()) {
    const std::string file = arguments.files.empty() ? "MEASUREMENT" : arguments.files.front();
    throw ExperimentError(
        "--page of infer draws estimates, not what --diagnose finds; its page: twinmap diagnose " +
        arguments.run + " " + file + " --page " + arguments.page);
  }
}

}  // namespace

void infer(const InferArguments& arguments) {
  keepFreedMemory();
  setThreads(arguments.threads);
  const bool is_of_several =
      arguments.segments || !arguments.trials.empty() || arguments.joint || arguments.windows;
  if (is_of_several && !arguments.profile.empty()) {
    throw ExperimentError("--profile is of one measurement at a time: leave it out, or infer each alone");
  }
  if (arguments.segments) {
    inferInSegments(arguments);
    return;
  }
  if (!arguments.trials.empty() || arguments.joint || arguments.windows) {
    inferJointly(arguments);
    return;
  }
  if (arguments.follow == !arguments.files.empty()) {
    throw ExperimentError(arguments.follow
                              ? "--follow reads measurements from the standard input; give no files"
                              : "give files of measurements, or --follow");
  }
  requireOnePage(arguments);
  std::ios::sync_with_stdio(false);
  std::optional<WaitingLine> preparing(std::in_place, "read " + arguments.run);
  InferCommand command(arguments);
  preparing.reset();
  command.printHeader();
  if (arguments.follow) {
    command.inferStream(std::cin);
  }
  for (const std::string& file : arguments.files) {
    command.inferFile(file);
  }
  command.finish();
}

}  // namespace twinmap::cli
