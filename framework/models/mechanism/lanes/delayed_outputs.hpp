#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/models/mechanism/single_program.hpp"
#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/sample.hpp"

namespace twinmap {

/// When the recorded outputs of a sample must be evaluated, of which some are those of a delay before, and
/// where they go: what OutputRecorder (kernels/lanes) does for lanes, for one integration at a time.
class DelayedOutputs {
 public:
  /// `times`: of the response, increasing, s. Those before the first phase are its begin.
  DelayedOutputs(const lanes::Problem& problem, const lanes::Sample& sample, const Eigen::VectorXd& times);

  /// Increasing, each once.
  const Eigen::VectorXd& getTimes() const { return times_; }

  /// What is wanted of the index-th of these times. `output`: evaluated there; `recorded`: one column an
  /// output, one row a time of the response.
  void keep(int index, const SingleProgram& output, Eigen::Ref<Eigen::MatrixXd> recorded) const;

 private:
  struct Place {
    int delay;  ///< of the sample's, or -1
    Eigen::Index row;
  };

  const std::vector<int>& output_delays_;
  Eigen::VectorXd times_;
  std::vector<std::vector<Place>> places_;  ///< of each of them
};

/// Takes from each output what the average of its sensor subtracts, by RecordedSampling::subtracted. `rows`:
/// output by output, each at `times` times; `recorded` likewise, with what is subtracted behind them.
template <class Recorded, class Rows>
void subtractBefore(const std::vector<int>& subtracted, Eigen::Index times, const Recorded& recorded,
                    Rows&& rows) {
  for (std::size_t i = 0; i < subtracted.size(); ++i) {
    if (const int place = subtracted[i]; place >= 0) {
      rows.middleRows(static_cast<Eigen::Index>(i) * times, times) -=
          recorded.middleRows(place * times, times);
    }
  }
}

}  // namespace twinmap
