#include "framework/serve/live/metrics.hpp"

#include <algorithm>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap::serve {
namespace {

/// As label values are written.
std::string escapeLabel(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '\n' ? "\\n" : c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  }
  return escaped;
}

std::string describe(const std::string& name, const char* type, const char* help) {
  return "# HELP " + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
}

/// label: `name="value"`; "": none.
std::string writeSample(const std::string& name, const std::string& label, const std::string& value) {
  return name + (label.empty() ? "" : "{" + label + "}") + " " + value + "\n";
}

std::string writeOne(const std::string& name, const char* type, const char* help, const std::string& value) {
  return describe(name, type, help) + writeSample(name, "", value);
}

std::string label(const char* name, const std::string& value) {
  return std::string(name) + "=\"" + escapeLabel(value) + "\"";
}

template <class Bounds, class Counts>
std::string writeHistogram(const Bounds& bounds, const Counts& counts, double sum) {
  const std::string name = "twinmap_measurement_duration_seconds";
  std::string text = describe(name, "histogram", "Time that inference and update of a measurement took.");
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    count += counts[i];
    const std::string bound = i < bounds.size() ? toText(bounds[i]) : "+Inf";
    text += writeSample(name + "_bucket", label("le", bound), std::to_string(count));
  }
  return text + writeSample(name + "_sum", "", toText(sum)) +
         writeSample(name + "_count", "", std::to_string(count));
}

}  // namespace

void Metrics::noteRequest(int status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++requests_[status];
}

void Metrics::noteMeasurement(const std::string& status, double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++measurements_[status];
  seconds_ += seconds;
  ++durations_[std::lower_bound(kBounds.begin(), kBounds.end(), seconds) - kBounds.begin()];
}

void Metrics::noteCommit() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++commits_;
}

void Metrics::setState(const Json& state) {
  std::map<std::string, Parameter> parameters;
  const Json beliefs = state.value("parameters", Json::object());
  for (const auto& [name, belief] : beliefs.items()) {
    if (belief.value("mean", Json()).is_number() && belief.value("sd", Json()).is_number()) {
      parameters[name] = {belief["mean"].get<double>(), belief["sd"].get<double>()};
    }
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  parameters_ = std::move(parameters);
  in_belief_ = state.value("measurements", std::uint64_t{0});
  alarms_ = state.value("alarms", Json::array()).size();
}

std::string Metrics::format(std::size_t waiting, int connections) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string text = describe("twinmap_build_info", "gauge", "The version of twinmap that serves.") +
                     writeSample("twinmap_build_info", label("version", version_), "1");
  text += describe("twinmap_http_requests_total", "counter", "Requests answered, by status code.");
  for (const auto& [code, count] : requests_) {
    text += writeSample("twinmap_http_requests_total", label("code", std::to_string(code)),
                        std::to_string(count));
  }
  text += describe("twinmap_measurements_total", "counter", "Measurements answered, by status.");
  for (const auto& [status, count] : measurements_) {
    text += writeSample("twinmap_measurements_total", label("status", status), std::to_string(count));
  }
  text += writeHistogram(kBounds, durations_, seconds_);
  text += writeOne("twinmap_commits_total", "counter", "Times that answers were written to disk together.",
                   std::to_string(commits_));
  text += writeOne("twinmap_measurements_waiting", "gauge", "Measurements that wait for their answer.",
                   std::to_string(waiting));
  text += writeOne("twinmap_http_connections", "gauge", "Open connections.", std::to_string(connections));
  text += writeOne("twinmap_belief_measurements", "gauge", "Measurements in the belief.",
                   std::to_string(in_belief_));
  text += writeOne("twinmap_alarms", "gauge", "Alarms that the belief holds.", std::to_string(alarms_));
  text += describe("twinmap_parameter_mean", "gauge", "Mean of a parameter now, in the unit of the model.");
  for (const auto& [name, parameter] : parameters_) {
    text += writeSample("twinmap_parameter_mean", label("parameter", name), toText(parameter.mean));
  }
  text += describe("twinmap_parameter_stddev", "gauge",
                   "Standard deviation of a parameter now, in the unit of the model.");
  for (const auto& [name, parameter] : parameters_) {
    text += writeSample("twinmap_parameter_stddev", label("parameter", name), toText(parameter.stddev));
  }
  return text;
}

}  // namespace twinmap::serve
