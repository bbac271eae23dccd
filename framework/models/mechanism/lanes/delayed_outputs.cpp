#include "framework/models/mechanism/lanes/delayed_outputs.hpp"

#include <algorithm>
#include <map>

namespace twinmap {

DelayedOutputs::DelayedOutputs(const lanes::Problem& problem, const lanes::Sample& sample,
                               const Eigen::VectorXd& times)
    : output_delays_(problem.output_delays) {
  std::map<double, std::vector<Place>> wanted;
  for (int delay = -1; delay < problem.delay_count; ++delay) {
    for (Eigen::Index row = 0; row < times.size(); ++row) {
      const double time =
          delay < 0 ? times[row] : std::max(times[row] - sample.delays[delay], sample.phases[0].begin);
      wanted[time].push_back({delay, row});
    }
  }
  times_.resize(static_cast<Eigen::Index>(wanted.size()));
  for (const auto& [time, places] : wanted) {
    times_[static_cast<Eigen::Index>(places_.size())] = time;
    places_.push_back(places);
  }
}

void DelayedOutputs::keep(int index, const SingleProgram& output,
                          Eigen::Ref<Eigen::MatrixXd> recorded) const {
  for (const Place& place : places_[static_cast<std::size_t>(index)]) {
    for (Eigen::Index i = 0; i < recorded.cols(); ++i) {
      const int delay = output_delays_.empty() ? -1 : output_delays_[static_cast<std::size_t>(i)];
      if (delay == place.delay) {
        recorded(place.row, i) = output.getOutput(static_cast<int>(i));
      }
    }
  }
}

}  // namespace twinmap
