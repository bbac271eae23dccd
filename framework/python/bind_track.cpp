#include <fmt/format.h>

#include <mutex>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/json/json.hpp"
#include "framework/data/measurement/files/time_stamp.hpp"
#include "framework/experiment/files/tracking_file.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/measured_columns.hpp"
#include "framework/python/python_experiment.hpp"
#include "framework/tracking/track_session.hpp"

namespace twinmap::python {
namespace {

/// How a twin is tracked, as it comes from Python.
struct TrackRequest {
  std::string file;  ///< with `tracking:`; "": that of the experiment
  std::string text;  ///< the same, where it is not a file
  TrackOptions options;
};

TrackRequest makeRequest(const std::string& file, const std::string& text,
                         const std::vector<std::string>& use, const Known& known, std::optional<bool> refine,
                         int lag) {
  TrackRequest request{file, text, {}};
  request.options.use = use;
  for (const auto& [name, value] : known) {
    request.options.known.push_back(fmt::format("{}={:.17g}", name, value));
  }
  request.options.session.refine = refine;
  request.options.lag = lag;
  return request;
}

/// Of a measurement what its table does not say. at: "" of none.
MeasurementContext makeContext(const std::string& at, std::optional<double> start, const std::string& trial) {
  MeasurementContext context{{}, start, trial};
  double time = 0.0;
  if (!at.empty() && !parseTime(at, time)) {
    throw MeasurementError("at: '" + at + "' must be a date and time, or seconds since 1970");
  }
  if (!at.empty()) {
    context.at = time;
  }
  return context;
}

/// A twin in time as Python holds it; from any thread, which takes its turn.
class PythonTrack {
 public:
  PythonTrack(TwinSource source, const std::string& state, TrackOptions options)
      : source_(std::move(source)), session_(std::in_place, source_, state, std::move(options)) {}

  std::string updateFile(const std::string& file, const std::string& at, std::optional<double> start,
                         const std::string& trial) {
    return answer(
        [&](TrackSession& session) { return session.updateFile(file, makeContext(at, start, trial)); });
  }

  std::string updateText(const std::string& text, const std::string& name, const std::string& at,
                         std::optional<double> start, const std::string& trial) {
    return answer(
        [&](TrackSession& session) { return session.update(text, name, makeContext(at, start, trial)); });
  }

  std::string getState() {
    return ask([](TrackSession& session) { return formatJson(session.getState()); });
  }
  std::string makeHistory() {
    return ask([](TrackSession& session) { return session.makeHistory(); });
  }
  void writePage(const std::string& file) {
    ask([&](TrackSession& session) {
      writeTextFile(file, session.makePage());
      return "";
    });
  }

  /// Lets go of the state file.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    session_.reset();
  }

 private:
  template <class Question>
  std::string ask(const Question& question) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!session_) {
      throw std::runtime_error("the track is closed");
    }
    return question(*session_);
  }

  /// What is answered is on the disk.
  template <class Update>
  std::string answer(const Update& update) {
    return ask([&](TrackSession& session) {
      const Json json = update(session);
      session.commit();
      return formatJson(json);
    });
  }

  const TwinSource source_;
  std::mutex mutex_;
  std::optional<TrackSession> session_;
};

std::unique_ptr<PythonTrack> openRun(const std::string& run, const std::string& state, TrackRequest request) {
  request.options.tracking = request.text.empty() ? findTracking(run, request.file)
                                                  : readTracking(parseYaml(request.text, "tracking"));
  return std::make_unique<PythonTrack>(TwinSource(std::filesystem::path(run)), state,
                                       std::move(request.options));
}

std::unique_ptr<PythonTrack> openExperiment(const PythonExperiment& experiment, const std::string& state,
                                            TrackRequest request) {
  request.options.tracking = !request.text.empty()   ? readTracking(parseYaml(request.text, "tracking"))
                             : !request.file.empty() ? findTracking("", request.file)
                                                     : readTracking(experiment.getTree());
  return std::make_unique<PythonTrack>(TwinSource(experiment.getTree()), state, std::move(request.options));
}

}  // namespace

void bindTrack(nb::module_& module) {
  using Release = nb::call_guard<nb::gil_scoped_release>;
  nb::class_<TrackRequest>(module, "TrackRequest")
      .def(
          "__init__",
          [](TrackRequest* made, const std::string& file, const std::string& text,
             const std::vector<std::string>& use, const Known& known, std::optional<bool> refine,
             int lag) { new (made) TrackRequest(makeRequest(file, text, use, known, refine, lag)); },
          nb::arg("file"), nb::arg("text"), nb::arg("use"), nb::arg("known"), nb::arg("refine"),
          nb::arg("lag"));
  nb::class_<PythonTrack>(module, "Track")
      .def_static("open_run", &openRun, Release())
      .def_static("open_experiment", &openExperiment, Release())
      .def("update_file", &PythonTrack::updateFile, Release())
      .def("update_text", &PythonTrack::updateText, Release())
      .def("get_state", &PythonTrack::getState, Release())
      .def("make_history", &PythonTrack::makeHistory, Release())
      .def("write_page", &PythonTrack::writePage, Release())
      .def("close", &PythonTrack::close, Release());
}

}  // namespace twinmap::python
