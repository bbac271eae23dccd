// A twin of four parameters (one walks at an unknown rate, one may have a slope, one steps every 5000
// measurements) over a million measurements: history, state file and belief of twinmap track, without
// inferences. Prints time, memory and the sizes of both files on the way.
//   track_endurance FOLDER [measurements] [measurements between two state files]
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <random>

#include "framework/base/files/atomic_file.hpp"
#include "framework/tracking/track_file.hpp"
#include "framework/tracking/track_history.hpp"

namespace {

using namespace twinmap;
namespace fs = std::filesystem;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kParameters = 4;
constexpr double kMeasured = 0.01;  // standard deviation of a measurement, in half-widths of the bounds
constexpr int kStep = 5000;         // measurements

tracking::Model makeModel() {
  tracking::Model model;
  model.drifts.resize(kParameters);
  model.drifts[0].rate = std::numeric_limits<double>::quiet_NaN();
  model.drifts[1].has_slope = true;
  model.mean = VectorXd::Zero(kParameters);
  model.covariance = MatrixXd::Identity(kParameters, kParameters) / 3.0;
  return model;
}

/// What measurements say of a machine that moves.
class Machine {
 public:
  TrackRecord measure(int number) {
    truth_[0] += 0.1 * kMeasured * normal_(random_);
    truth_[0] *= 0.999;  // within the bounds for ever
    truth_[2] = number / kStep % 2 == 0 ? 0.1 : 0.2;
    TrackRecord record{"m" + std::to_string(number) + ".csv", std::string(32, 'a'), "ok"};
    record.estimate = truth_;
    for (double& value : record.estimate) {
      value += kMeasured * normal_(random_);
    }
    record.covariates = {{"the amplitude of x", 0.1 * normal_(random_)}};
    record.measurement = {
        static_cast<double>(number), MatrixXd::Identity(kParameters, kParameters) / kMeasured,
        record.estimate / kMeasured, VectorXd::Constant(kParameters, kMeasured * kMeasured), VectorXd()};
    return record;
  }

 private:
  std::mt19937 random_{5};
  std::normal_distribution<double> normal_;
  VectorXd truth_ = VectorXd::Zero(kParameters);
};

/// Of a processor.
double readSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto add = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return add(usage.ru_utime) + add(usage.ru_stime);
}

double readPeakMebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void live(const fs::path& folder, int count, int between) {
  const fs::path state = folder / "track.h5";
  const TrackIdentity identity{"endurance", "", ""};
  TrackedTwin twin(makeModel(), 100);
  TrackHistory history(folder / "track.jsonl", 0);
  Machine machine;
  const double begin = readSeconds();
  for (int number = 1; number <= count; ++number) {
    const TrackRecord record = machine.measure(number);
    history.add(record);
    twin.add(record);
    if (number % between == 0) {
      syncFile(history.getFile());
      writeTrackFile(state, identity, twin, history.getBytes());
    }
    if (number % (count / 10) == 0) {
      std::cout << number << " measurements: " << 1e6 * (readSeconds() - begin) / number << " us each, peak "
                << readPeakMebibytes() << " MiB, state " << fs::file_size(state) << " bytes, history "
                << history.getBytes() / number << " bytes each, " << twin.getNow().alarm_count << " alarms"
                << std::endl;
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "track_endurance FOLDER [measurements] [measurements between two state files]\n";
    return 2;
  }
  live(arguments[1], count > 2 ? std::atoi(arguments[2]) : 1000000,
       count > 3 ? std::atoi(arguments[3]) : 1000);
  return 0;
}
