#pragma once

#include <random>
#include <vector>

#include "tests/kernels/lanes/two_beam.hpp"

namespace twinmap::lanes::testing {

/// Samples of one problem with the memory of their results.
struct Batch {
  std::vector<double> outputs, derivatives;
  std::vector<Sample> samples;
  std::vector<Result> results;

  void add(const Sample& sample, int values, int directions) {
    samples.push_back(sample);
    values_ = values;
    directions_ = directions;
  }
  void run(Integrator& integrator) {
    outputs.assign(samples.size() * values_, -99.0);
    derivatives.assign(samples.size() * values_ * directions_, -99.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].outputs = outputs.data() + i * values_;
      samples[i].derivatives = derivatives.data() + i * values_ * directions_;
    }
    results = integrate(integrator, samples);
  }

 private:
  int values_ = 0, directions_ = 0;
};

/// Points of the two beams' box, the same on every call.
inline std::vector<std::vector<double>> drawPoints(int count) {
  std::mt19937_64 engine(20221);
  std::uniform_real_distribution<> uniform;
  std::vector<std::vector<double>> points;
  for (int i = 0; i < count; ++i) {
    const double u[4] = {uniform(engine), uniform(engine), uniform(engine), uniform(engine)};
    points.push_back(two_beam::makePoint(u));
  }
  return points;
}

inline Options makeTwoBeamOptions(int directions) {
  Options options;
  if (directions > 0) {
    options.parameter_scales = {0.2, 5e-5, 10.0, 0.018};
  }
  return options;
}

}  // namespace twinmap::lanes::testing
