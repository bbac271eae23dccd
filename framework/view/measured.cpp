#include "framework/view/measured.hpp"

#include <algorithm>
#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/equations/outputs.hpp"
#include "framework/view/point_values.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap::view {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The body that an output belongs to; -1: none.
int findBody(const OutputSpec& output, const SystemNames& names) {
  for (const std::optional<Name>* coordinate : {&output.coordinate, &output.speed}) {
    if (*coordinate) {
      return names.getCoordinates()[static_cast<std::size_t>(names.findCoordinate(**coordinate))].body;
    }
  }
  for (const auto* station : {&output.position, &output.velocity, &output.acceleration}) {
    if (*station) {
      return names.findBody((*station)->station.body);
    }
  }
  for (const auto* sensor : {&output.specific_force, &output.angular_velocity}) {
    if (*sensor) {
      return names.findBody((*sensor)->station.body);
    }
  }
  return output.reaction ? names.findJoint(output.reaction->joint) : -1;
}

/// Less measured and updated in noise sds, or in % of the measured range where the noise is not known.
std::vector<double> calcResidual(const Measurement& measurement, Index output, std::string& scale) {
  const Index times = measurement.layout.times.size(), first = measurement.layout.getRow(output, 0);
  const auto measured = measurement.measured.segment(first, times);
  double low = HUGE_VAL, high = -HUGE_VAL;
  bool has_stddev = true;
  for (Index i = 0; i < times; ++i) {
    if (std::isfinite(measured[i])) {
      low = std::min(low, measured[i]);
      high = std::max(high, measured[i]);
      has_stddev = has_stddev && measurement.noise_stddev[first + i] > 0.0;
    }
  }
  scale = has_stddev ? "sd" : "% of range";
  std::vector<double> residual;
  for (Index i = 0; i < times; ++i) {
    const double unit =
        has_stddev ? measurement.noise_stddev[first + i] : 0.01 * std::max(high - low, 1e-300);
    residual.push_back((measured[i] - measurement.updated[first + i]) / unit);
  }
  return residual;
}

/// At each time of the scene the rms of what lies nearest to it, or of what was before; NaN after the last.
std::vector<double> sumUp(const VectorXd& times, const std::vector<double>& residual,
                          const VectorXd& frames) {
  std::vector<double> sums(static_cast<std::size_t>(frames.size())), counts(sums.size());
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (std::isfinite(residual[i])) {
      Index nearest = 0;
      (frames.array() - times[static_cast<Index>(i)]).abs().minCoeff(&nearest);
      sums[static_cast<std::size_t>(nearest)] += residual[i] * residual[i];
      counts[static_cast<std::size_t>(nearest)] += 1.0;
    }
  }
  const auto last = std::find_if(counts.rbegin(), counts.rend(), [](double count) { return count > 0.0; });
  const std::size_t known = counts.rend() - last;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const bool is_gap = counts[i] == 0.0 && i > 0 && i < known;
    sums[i] = is_gap ? sums[i - 1] : std::sqrt(sums[i] / counts[i]);
  }
  return sums;
}

SceneMeasured describeOutput(const Measurement& measurement, Index output, const VectorXd& frames) {
  constexpr Index kMostDrawn = 2000;
  const VectorXd& times = measurement.layout.times;
  SceneMeasured drawn;
  drawn.residual = sumUp(times, calcResidual(measurement, output, drawn.scale), frames);
  const Index step = (times.size() + kMostDrawn - 1) / kMostDrawn;
  for (Index i = 0; i < times.size(); i += step) {
    const double value = measurement.measured[measurement.layout.getRow(output, i)];
    if (std::isfinite(value)) {
      drawn.times.push_back(times[i]);
      drawn.values.push_back(value);
    }
  }
  return drawn;
}

/// Between the samples that are there; NaN outside of them.
double interpolate(const SceneMeasured& measured, double time) {
  const auto after = std::lower_bound(measured.times.begin(), measured.times.end(), time);
  if (after == measured.times.end()) {
    return NAN;
  }
  const std::size_t i = after - measured.times.begin();
  if (*after == time || i == 0) {
    return *after == time ? measured.values[i] : NAN;
  }
  const double share = (time - measured.times[i - 1]) / (measured.times[i] - measured.times[i - 1]);
  return measured.values[i - 1] + share * (measured.values[i] - measured.values[i - 1]);
}

/// What a sensor of a coordinate or a position reads, which depends on the pose alone.
class PoseSensors {
 public:
  PoseSensors(const ModelSpec& model, const PointValues& at, const Scene& scene) : at_(at) {
    for (std::size_t i = 0; i < scene.outputs.size(); ++i) {
      const auto spec =
          std::find_if(model.outputs.begin(), model.outputs.end(),
                       [&](const OutputSpec& output) { return output.name.text == scene.outputs[i].name; });
      if (scene.outputs[i].measured && spec != model.outputs.end() && (spec->coordinate || spec->position)) {
        const std::vector<double>& values = scene.outputs[i].measured->values;
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        const bool varies = !values.empty() && *high > *low;
        sensors_.push_back({&*spec, &*scene.outputs[i].measured, varies ? *high - *low : 1.0});
      }
    }
  }

  bool isEmpty() const { return sensors_.empty(); }

  /// The coordinates nearest to `q` that explain what was measured, by Gauss and Newton's method; each sensor
  /// counts by its range.
  VectorXd follow(double time, VectorXd q) const {
    constexpr int kIterations = 5;
    constexpr double kStep = 1e-6;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const VectorXd residual = calcResidual(time, q);
      MatrixXd slopes(residual.size(), q.size());
      for (Index k = 0; k < q.size(); ++k) {
        VectorXd beside = q;
        beside[k] += kStep;
        slopes.col(k) = (residual - calcResidual(time, beside)) / kStep;
      }
      q += linalg::solveMinimumNorm(slopes, residual);
    }
    return q;
  }

 private:
  struct Sensor {
    const OutputSpec* spec;
    const SceneMeasured* measured;
    double range;
  };

  /// Measured less what it reads; 0 where nothing was measured.
  VectorXd calcResidual(double time, const VectorXd& q) const {
    const std::vector<Pose> poses = calcPoses(at_.values, {q.begin(), q.end()});
    VectorXd residual(static_cast<Index>(sensors_.size()));
    for (Index i = 0; i < residual.size(); ++i) {
      const Sensor& sensor = sensors_[static_cast<std::size_t>(i)];
      const double measured = interpolate(*sensor.measured, time);
      residual[i] = std::isfinite(measured) ? (measured - read(*sensor.spec, poses, q)) / sensor.range : 0.0;
    }
    return residual;
  }

  double read(const OutputSpec& spec, const std::vector<Pose>& poses, const VectorXd& q) const {
    const NamedValues<double>& numbers = at_.numbers.getValues();
    double quantity = 0.0;
    if (spec.coordinate) {
      quantity = q[at_.names.findCoordinate(*spec.coordinate)];
    } else {
      const auto station = equations::calcStation(spec.position->station, at_.names, numbers);
      const Pose& pose = poses[static_cast<std::size_t>(station.body)];
      quantity = algebra::dot(pose.rotation * station.point + pose.origin,
                              equations::normalize(numbers.calc3(spec.position->direction)));
    }
    return numbers.calc(spec.gain, 1.0) * quantity + numbers.calc(spec.offset, 0.0);
  }

  const PointValues& at_;
  std::vector<Sensor> sensors_;
};

void addMeasuredMotion(const ModelSpec& model, const PointValues& at, Scene& scene) {
  const PoseSensors sensors(model, at, scene);
  if (sensors.isEmpty() || !model.system.constraints.empty()) {
    return;
  }
  const MatrixXd& updated = scene.motions.back().coordinates;
  SceneMotion motion{"measured", {}, MatrixXd(0, 0), updated};
  for (Index frame = 0; frame < updated.cols(); ++frame) {
    motion.coordinates.col(frame) = sensors.follow(scene.times[frame], updated.col(frame));
    const auto q = motion.coordinates.col(frame);
    motion.poses.push_back(calcPoses(at.values, {q.begin(), q.end()}));
  }
  scene.motions.push_back(std::move(motion));
}

}  // namespace

void addMeasurement(const ExperimentSpec& experiment, const VectorXd& point, const Measurement& measurement,
                    Scene& scene) {
  const ModelSpec& model = experiment.model;
  const std::vector<std::string>& names = measurement.layout.output_names;
  for (SceneOutput& output : scene.outputs) {
    const auto place = std::find(names.begin(), names.end(), output.name);
    if (place != names.end() && measurement.layout.times.size() > 0) {
      output.measured = describeOutput(measurement, place - names.begin(), scene.times);
    }
  }
  if (model.source) {
    return;
  }
  const PointValues at(model, point);
  for (SceneOutput& output : scene.outputs) {
    for (const OutputSpec& spec : model.outputs) {
      output.body = spec.name.text == output.name ? findBody(spec, at.names) : output.body;
    }
  }
  addMeasuredMotion(model, at, scene);
}

}  // namespace twinmap::view
