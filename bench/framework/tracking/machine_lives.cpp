// Lives of machines that are simulated, each measurement inferred and tracked as `twinmap track` does; one
// line of JSON. bench/tracking.py calls it.
//   machine_lives RUN FILE.yaml FOLDER [key=value ...]
// RUN is what tracks; FILE is its experiment, from which the machines are made. Keys with a dot are values of
// the machine's file that the model has not ("constants.friction=.05"). walk, slope and step are in standard
// deviations of a measurement.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <sstream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/json/json.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/files/table.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/tracking_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/tracking/track_session.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Options {
  std::map<std::string, double> values{{"lives", 20},  {"measurements", 300},
                                       {"first", 0},   {"walk", 0},  // of a step of each parameter's walk
                                       {"slope", 0},                 // of each parameter, a measurement
                                       {"step", 0},                  // of the parameter `worn`
                                       {"worn", 0},                  // number of the parameter that steps
                                       {"at", 100},                  // the measurement before which it steps
                                       {"bad", 0},      // share of measurements that are of another machine
                                       {"refine", 0},   // whether on the simulator, as track does by itself
                                       {"dropout", 0},  // share of measurements that are not there
                                       {"decay", 0}};   // whether nuisance parameters go from .95 of their
                                                        // range to .05 of it, instead of anywhere
  std::vector<std::string> machine;                     // overrides
  std::string drift;  // of the section tracking, of each parameter; "": constant
  double operator[](const char* key) const { return values.at(key); }
};

/// Machines of an experiment, measured.
class Workshop {
 public:
  Workshop(const ExperimentSpec& experiment, const Options& options)
      : options_(options),
        experiment_(experiment),
        layout_(makeLayout(experiment_)),
        noise_(experiment_.noise, layout_),
        simulator_(makeSimulator(experiment_.model, layout_.times, layout_.modes)),
        sampled_(collectSampled(experiment_.model)) {}

  Index countParameters() const { return static_cast<Index>(experiment_.model.parameters.size()); }
  const ParameterSpec& getParameter(Index j) const { return sampled_[static_cast<std::size_t>(j)]; }

  /// Files of a batch of points (u x n) as text.
  std::vector<std::string> measure(const MatrixXd& points, std::uint64_t seed) const {
    MatrixXd responses(layout_.getRowCount(), points.cols());
    std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
    simulator_->simulate(points, responses, statuses.data());
    const MatrixXd noisy = addNoise(responses, noise_, {seed, RandomPurpose::kTestNoise});
    std::vector<std::string> files;
    for (Index i = 0; i < points.cols(); ++i) {
      if (!statuses[static_cast<std::size_t>(i)].ok) {
        throw std::runtime_error("a machine cannot be simulated: " +
                                 statuses[static_cast<std::size_t>(i)].reason);
      }
      files.push_back(write(noisy.col(i)));
    }
    return files;
  }

  /// p x N: parameters of a life; then the nuisance parameters of each measurement below (u x N).
  MatrixXd live(const VectorXd& stddev, std::mt19937& random) const {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto count = static_cast<Index>(options_["measurements"]);
    MatrixXd points(static_cast<Index>(sampled_.size()), count);
    VectorXd level(countParameters());
    for (Index j = 0; j < level.size(); ++j) {
      level[j] = at(j, 0.35 + 0.3 * uniform(random));
    }
    for (Index i = 0; i < count; ++i) {
      for (Index j = 0; j < level.size(); ++j) {
        level[j] += stddev[j] * (options_["walk"] * normal(random) + options_["slope"]);
        level[j] += i == static_cast<Index>(options_["at"]) && j == static_cast<Index>(options_["worn"])
                        ? options_["step"] * stddev[j]
                        : 0.0;
        level[j] = std::min(std::max(level[j], at(j, 0.01)), at(j, 0.99));
      }
      points.col(i).head(level.size()) = level;
      const double along = static_cast<double>(i) / static_cast<double>(std::max<Index>(count - 1, 1));
      for (Index j = level.size(); j < points.rows(); ++j) {
        points(j, i) = at(
            j, options_["decay"] > 0.0 ? 0.95 * std::pow(0.05 / 0.95, along) : 0.1 + 0.8 * uniform(random));
      }
    }
    return points;
  }

  /// Another machine.
  VectorXd draw(std::mt19937& random) const {
    std::uniform_real_distribution<double> uniform;
    return VectorXd::NullaryExpr(static_cast<Index>(sampled_.size()),
                                 [&](Index j) { return at(j, 0.1 + 0.8 * uniform(random)); });
  }

 private:
  double at(Index j, double share) const {
    const Bounds& bounds = getParameter(j).bounds;
    return bounds.lower + share * (bounds.upper - bounds.lower);
  }

  std::string write(const VectorXd& response) const {
    const Index times = layout_.times.size();
    std::vector<Column> columns{{"t", "s", layout_.times}};
    for (std::size_t o = 0; o < layout_.output_names.size(); ++o) {
      columns.push_back({layout_.output_names[o], layout_.output_units[o],
                         response.segment(layout_.getRow(static_cast<Index>(o), 0), times)});
    }
    std::ostringstream text;
    writeTable(text, columns);
    return text.str();
  }

  const Options& options_;
  const ExperimentSpec experiment_;
  const ResponseLayout layout_;
  const ResponseNoise noise_;
  const std::unique_ptr<Simulator> simulator_;
  const std::vector<ParameterSpec> sampled_;
};

struct Held {
  long long held = 0, all = 0;
  void add(bool holds) { held += holds ? 1 : 0, ++all; }
};

Json toJson(const Held& held) {
  return {held.held, held.all};
}

class Study {
 public:
  Study(const fs::path& run, const std::string& file, fs::path folder, const Options& options)
      : options_(options),
        folder_(std::move(folder)),
        twin_(run),
        workshop_(loadExperiment(file, options.machine), options) {
    track_.session.refine = options["refine"] > 0.0;
    const fs::path tracking = folder_ / "tracking.yaml";
    std::string section = "tracking:\n  time: {}\n";
    if (!options.drift.empty()) {
      section = "tracking:\n  drift:\n";
      for (Index j = 0; j < workshop_.countParameters(); ++j) {
        section += "    " + workshop_.getParameter(j).name.text + ": " + options.drift + "\n";
      }
    }
    writeTextFile(tracking, section);
    track_.tracking = loadTracking(tracking.string());
    findStddevs();
  }

  void run() {
    const auto first = static_cast<unsigned>(options_["first"]);
    for (unsigned l = first; l < first + static_cast<unsigned>(options_["lives"]); ++l) {
      live(l);
    }
  }

  Json makeJson() const {
    return {{"measurements", measurements_},
            {"updates", updates_},
            {"statuses", statuses_},
            {"filtered", toJson(filtered_)},
            {"smoothed", toJson(smoothed_)},
            {"ratios", ratios_},
            {"alarms", alarms_},
            {"delays", delays_}};
  }

 private:
  /// Of each parameter, that of a measurement: the median of machines near the middle.
  void findStddevs() {
    constexpr int kMachines = 21;
    std::mt19937 random(99);
    const std::unique_ptr<MeasurementInference> inference =
        twin_.getMembers().front().source->makeSession(track_.session);
    MatrixXd stddevs(workshop_.countParameters(), kMachines);
    for (int i = 0; i < kMachines; ++i) {
      const std::string text =
          workshop_.measure(workshop_.draw(random), static_cast<std::uint64_t>(i)).front();
      std::istringstream stream(text);
      stddevs.col(i) = selectEstimate(inference->infer(readCsv(stream, "machine"), {}, {})).stddev;
    }
    stddev_.resize(stddevs.rows());
    for (Index j = 0; j < stddevs.rows(); ++j) {
      VectorXd row = stddevs.row(j);
      std::nth_element(row.begin(), row.begin() + kMachines / 2, row.end());
      stddev_[j] = row[kMachines / 2];
    }
  }

  void live(unsigned life) {
    std::mt19937 random(1000U + life);
    std::uniform_real_distribution<double> uniform;
    const MatrixXd truth = workshop_.live(stddev_, random);
    MatrixXd measured = truth;
    for (Index i = 0; i < measured.cols(); ++i) {
      if (uniform(random) < options_["bad"]) {
        measured.col(i) = workshop_.draw(random);
      }
    }
    const std::vector<std::string> files = workshop_.measure(measured, 1000 + life);
    const fs::path state = folder_ / fmt::format("life{}.h5", life);
    fs::remove(fs::path(state).replace_extension(".jsonl"));
    TrackSession session(twin_, state, track_);
    std::vector<Index> there;
    Json alarms = Json::array(), last;
    for (Index i = 0; i < truth.cols(); ++i) {
      if (i > 0 && uniform(random) < options_["dropout"]) {
        continue;
      }
      there.push_back(i);
      last = session.update(files[static_cast<std::size_t>(i)], fmt::format("m{}", i),
                            {static_cast<double>(i), {}});
      count(last, truth.col(i));
      for (const Json& alarm : last["track"]["alarms"]) {
        alarms.push_back(describe(alarm));
      }
    }
    noteDelay(alarms);
    noteRatios(last);
    compareSmoothed(session.makeHistory(), truth, there);
    alarms_.push_back(alarms);
    fs::remove(session.getHistoryFile());
  }

  static Json describe(const Json& alarm) {
    Json one{{"announced", alarm["announced"]}, {"parameter", alarm["parameter"]}};
    if (alarm.contains("drift_or_model")) {
      one["time"] = alarm["time"];
      one["rivals"] = alarm["drift_or_model"]["rivals"];
      one["diagnosis"] = alarm["drift_or_model"].value("diagnosis", Json());
    }
    return one;
  }

  void count(const Json& answer, const VectorXd& truth) {
    const Json& track = answer["track"];
    ++measurements_;
    updates_ += track["updates"].get<bool>() ? 1 : 0;
    ++statuses_[answer.value("status", answer.contains("statuses") ? formatJson(answer["statuses"]) : "")];
    for (Index j = 0; j < workshop_.countParameters(); ++j) {
      const Json& one = track["parameters"][workshop_.getParameter(j).name.text];
      filtered_.add(one["lower"].get<double>() <= truth[j] && truth[j] <= one["upper"].get<double>());
    }
  }

  void noteDelay(const Json& alarms) {
    for (const Json& alarm : alarms) {
      const double after = alarm["announced"].get<double>() - options_["at"];
      if (options_["step"] != 0.0 && after >= 0.0) {
        delays_.push_back(after + 1.0);
        return;
      }
    }
  }

  void noteRatios(const Json& last) {
    for (Index j = 0; options_["walk"] > 0.0 && j < workshop_.countParameters(); ++j) {
      const Json& walk = last["track"]["parameters"][workshop_.getParameter(j).name.text]["walk"];
      ratios_.push_back(walk["sd"].get<double>() / (options_["walk"] * stddev_[j]));
    }
  }

  void compareSmoothed(const std::string& history, const MatrixXd& truth, const std::vector<Index>& there) {
    std::istringstream lines(history);
    std::string line;
    std::getline(lines, line);
    for (const Index i : there) {
      for (Index j = 0; j < workshop_.countParameters(); ++j) {
        std::getline(lines, line);
        const std::size_t comma = line.rfind(','), before = line.rfind(',', comma - 1);
        const double lower = std::strtod(line.c_str() + before + 1, nullptr);
        const double upper = std::strtod(line.c_str() + comma + 1, nullptr);
        smoothed_.add(lower <= truth(j, i) && truth(j, i) <= upper);
      }
    }
  }

  const Options& options_;
  const fs::path folder_;
  const TwinSource twin_;
  const Workshop workshop_;
  TrackOptions track_;
  VectorXd stddev_;
  long long measurements_ = 0, updates_ = 0;
  std::map<std::string, int> statuses_;
  Held filtered_, smoothed_;
  std::vector<double> ratios_, delays_;
  Json alarms_ = Json::array();
};

Options readOptions(int count, char** arguments) {
  Options options;
  for (int i = 4; i < count; ++i) {
    const std::string text = arguments[i];
    const std::size_t equal = text.find('=');
    const std::string key = text.substr(0, equal);
    if (const auto found = options.values.find(key);
        equal != std::string::npos && found != options.values.end()) {
      found->second = std::strtod(text.c_str() + equal + 1, nullptr);
    } else if (key == "drift") {
      options.drift = text.substr(equal + 1);
    } else if (equal != std::string::npos && key.find('.') != std::string::npos) {
      options.machine.push_back(text);
    } else {
      throw std::runtime_error(text + ": not a key=value of this program");
    }
  }
  return options;
}

}  // namespace
}  // namespace twinmap

int main(int count, char** arguments) {
  if (count < 4) {
    std::fputs("machine_lives RUN FILE.yaml FOLDER [key=value ...]\n", stderr);
    return EXIT_FAILURE;
  }
  try {
    const twinmap::Options options = twinmap::readOptions(count, arguments);
    std::filesystem::create_directories(arguments[3]);
    twinmap::Study study(arguments[1], arguments[2], arguments[3], options);
    study.run();
    std::puts(twinmap::formatJson(study.makeJson()).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
