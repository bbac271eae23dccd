// Lives of machines whose measurements are normal and drawn directly, tracked; one line of JSON.
// bench/tracking.py calls it.
//   kernels_tracking_lives [key=value ...]
// The keys are fields of Options below. Sizes are in standard deviations of one measurement.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "kernels/tracking/outlook.hpp"
#include "kernels/tracking/whole_course.hpp"

namespace twinmap::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMeasured = 0.01;  // standard deviation of a measurement, in the units of the prior

struct Options {
  std::map<std::string, double> values{
      {"parameters", 1},
      {"lives", 200},
      {"measurements", 300},
      {"seed", 1},
      {"walk", 0},         // of a step of each parameter's walk
      {"told", 0},         // the tracker's walk; -1: it does not know it
      {"slope", 0},        // of each parameter, a measurement
      {"trend", 0},        // whether the tracker knows of a slope
      {"step", 0},         // of the first parameter
      {"at", 100},         // the measurement before which it steps
      {"bad", 0},          // share of measurements that are 50 standard deviations off
      {"dropout", 0},      // share of measurements that are not there
      {"temperature", 0},  // effect of a condition upon the first parameter, which the tracker knows of
      {"false_alarms", 1e-3},
      {"limit", 0},    // distance of a limit of the first parameter
      {"from", 200},   // the measurement behind which its crossing is forecast
      {"courses", 1},  // whether to smooth
      {"dump", 0}};    // whether to print the first life
  double operator[](const char* key) const { return values.at(key); }
};

Model makeModel(const Options& options) {
  Model model;
  const auto p = static_cast<Index>(options["parameters"]);
  const double told = options["told"];
  const double rate = told < 0.0 ? std::numeric_limits<double>::quiet_NaN() : std::pow(told * kMeasured, 2);
  model.drifts.assign(static_cast<std::size_t>(p), {rate, options["trend"] > 0.0});
  model.mean = VectorXd::Zero(p);
  model.covariance = MatrixXd::Identity(p, p) / 3.0;
  model.false_alarms = options["false_alarms"];
  if (options["temperature"] > 0.0) {
    model.follows = {{0, 0}};
    model.conditions = 1;
  }
  return model;
}

struct Life {
  std::vector<Measurement> measurements;
  MatrixXd truth;                      // p x N
  double crossing = Crossing::kNever;  // after the measurement `from`
};

class LifeDrawer {
 public:
  LifeDrawer(const Options& options, unsigned life)
      : options_(options), random_(static_cast<unsigned>(options["seed"]) * 100003U + life) {}

  Life draw() {
    const auto p = static_cast<Index>(options_["parameters"]),
               count = static_cast<Index>(options_["measurements"]);
    Life life;
    life.truth.resize(p, count);
    VectorXd truth(p);
    for (double& value : truth) {
      value = 0.3 * normal();
    }
    Index place = 0;
    for (Index time = 0; place < count; ++time) {
      move(truth);
      if (place == static_cast<Index>(options_["at"]) && !has_stepped_) {
        truth[0] += options_["step"] * kMeasured;
        has_stepped_ = true;
      }
      if (time > 0 && uniform_(random_) < options_["dropout"]) {
        continue;
      }
      life.truth.col(place++) = truth;
      life.measurements.push_back(measure(truth, static_cast<double>(time)));
    }
    return life;
  }

  /// Of a level that goes on from the truth, in steps of a 16th, until it is below the limit.
  double findCrossing(double level, double limit) {
    constexpr int kParts = 16;
    for (int i = 0; i < 1000 * kParts; ++i) {
      level += kMeasured * (options_["walk"] * normal() / std::sqrt(kParts) + options_["slope"] / kParts);
      if (level < limit) {
        return (i + 1.0) / kParts;
      }
    }
    return Crossing::kNever;
  }

 private:
  double normal() { return normal_(random_); }

  void move(VectorXd& truth) {
    for (double& value : truth) {
      value += kMeasured * (options_["walk"] * normal() + options_["slope"]);
    }
  }

  Measurement measure(const VectorXd& truth, double time) {
    constexpr double kFar = 50.0, kDay = 30.0;
    const Index p = truth.size();
    Measurement measurement{time, MatrixXd::Identity(p, p) / kMeasured, truth / kMeasured,
                            VectorXd::Constant(p, kMeasured * kMeasured), VectorXd()};
    if (options_["temperature"] > 0.0) {
      const double warm = std::sin(time / kDay * 6.283) + 0.3 * normal();
      measurement.conditions = VectorXd::Constant(1, 20.0 + 5.0 * warm);
      measurement.values[0] += options_["temperature"] * warm;
    }
    const double noise = uniform_(random_) < options_["bad"] ? kFar : 1.0;
    for (double& value : measurement.values) {
      value += noise * normal();
    }
    return measurement;
  }

  const Options& options_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
  bool has_stepped_ = false;
};

struct Held {
  long long held = 0, all = 0;
  void add(bool holds) { held += holds ? 1 : 0, ++all; }
  double calcShare() const { return all > 0 ? static_cast<double>(held) / static_cast<double>(all) : 0.0; }
};

class Study {
 public:
  explicit Study(const Options& options) : options_(options), model_(makeModel(options)) {}

  void run() {
    for (unsigned l = 0; l < static_cast<unsigned>(options_["lives"]); ++l) {
      LifeDrawer drawer(options_, l);
      const Life life = drawer.draw();
      watch(life, drawer);
      if (options_["courses"] > 0.0) {
        compare(life);
      }
    }
  }

  void print() {
    std::printf(
        "{\"measurements\": %lld, \"alarms\": %lld, \"filtered\": %.4f, \"smoothed\": %.4f, \"forecast\": "
        "%.4f, "
        "\"forecasts\": %lld, \"missed\": %d, ",
        measurements_, alarms_, filtered_.calcShare(), smoothed_.calcShare(), forecast_.calcShare(),
        forecast_.all, missed_);
    printNumbers("ratios", ratios_);
    std::printf(", ");
    printNumbers("delays", delays_);
    if (options_["dump"] > 0.0) {
      printCourse();
    }
    std::printf("}\n");
  }

 private:
  static void printNumbers(const char* name, const std::vector<double>& numbers) {
    std::printf("\"%s\": [", name);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      std::printf("%s%.17g", i > 0 ? ", " : "", numbers[i]);
    }
    std::printf("]");
  }

  void watch(const Life& life, LifeDrawer& drawer) {
    Tracker tracker(model_);
    const bool steps = options_["step"] != 0.0;
    const auto at = static_cast<std::size_t>(options_["at"]),
               from = static_cast<std::size_t>(options_["from"]);
    bool found = false;
    for (std::size_t i = 0; i < life.measurements.size(); ++i) {
      const Step step = tracker.advance(life.measurements[i]);
      const bool alarm = step.change || step.has_begun_anew;
      ++measurements_;
      if (alarm && steps && i >= at && !found) {
        delays_.push_back(static_cast<double>(i - at + 1));
        found = true;
      } else if (alarm && !(steps && i >= at)) {
        ++alarms_;
      }
      if (options_["limit"] > 0.0 && i == from) {
        forecast(tracker, life.truth(0, static_cast<Index>(i)), drawer);
      }
    }
    missed_ += steps && !found ? 1 : 0;
    if (std::isnan(model_.drifts[0].rate) && options_["walk"] > 0.0) {
      for (const RateFilters& filters : tracker.getState().filters) {
        ratios_.push_back(estimateRate(calcRatePosterior(filters)).median / options_["walk"]);
      }
    }
  }

  void forecast(const Tracker& tracker, double truth, LifeDrawer& drawer) {
    constexpr double kLongest = 1000.0;
    const Outlook outlook = calcOutlook(tracker, 0);
    const double limit = outlook.mean - options_["limit"] * kMeasured;
    const Crossing crossing = tracking::findCrossing(outlook, limit, true, kLongest);
    const double when = drawer.findCrossing(truth, limit);
    forecast_.add(crossing.lower <= when && when <= crossing.upper);
  }

  void compare(const Life& life) {
    const WholeCourse course = calcWholeCourse(model_, life.measurements);
    add(course.filtered, life.truth, filtered_);
    add(course.smoothed, life.truth, smoothed_);
    if (first_.used.empty()) {
      first_ = course;
      first_life_ = life;
    }
  }

  static void add(const Course& course, const MatrixXd& truth, Held& held) {
    const Eigen::ArrayXXd off = (course.means - truth).cwiseAbs().array() / course.stddevs.array();
    for (Index i = 0; i < off.size(); ++i) {
      held.add(off.data()[i] < 1.959964);
    }
  }

  void printCourse() const {
    const auto print = [](const char* name, const MatrixXd& values) {
      std::printf(", ");
      printNumbers(name, std::vector<double>(values.data(), values.data() + values.size()));
    };
    std::vector<double> values;
    for (const Measurement& measurement : first_life_.measurements) {
      values.insert(values.end(), measurement.values.begin(), measurement.values.end());
    }
    std::printf(", \"left_out\": %d, ",
                static_cast<int>(std::count(first_.used.begin(), first_.used.end(), false)));
    printNumbers("values", values);
    print("filtered_mean", first_.filtered.means), print("filtered_sd", first_.filtered.stddevs);
    print("smoothed_mean", first_.smoothed.means), print("smoothed_sd", first_.smoothed.stddevs);
  }

  const Options& options_;
  const Model model_;
  long long measurements_ = 0, alarms_ = 0;
  int missed_ = 0;
  Held filtered_, smoothed_, forecast_;
  std::vector<double> ratios_, delays_;
  WholeCourse first_;
  Life first_life_;
};

int run(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string text = arguments[i];
    const std::size_t equal = text.find('=');
    const auto found = options.values.find(text.substr(0, equal));
    if (equal == std::string::npos || found == options.values.end()) {
      std::fprintf(stderr, "%s: not a key=value of this program\n", arguments[i]);
      return EXIT_FAILURE;
    }
    found->second = std::strtod(text.c_str() + equal + 1, nullptr);
  }
  Study study(options);
  study.run();
  study.print();
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace twinmap::tracking

int main(int count, char** arguments) {
  return twinmap::tracking::run(count, arguments);
}
