#include "framework/diagnosis/blind_spots.hpp"

#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<BlindSpot> calcBlindSpots(const ScoredCandidates& scored, Index p, double level) {
  const double needed = calcCriticalZ(level, scored.tested) + calcCriticalZ(0.1, 1);  // 95 %, one-sided
  std::vector<BlindSpot> spots;
  for (std::size_t i = 0; i < scored.candidates.size(); ++i) {
    BlindSpot spot{scored.candidates[i], kInfinity, VectorXd::Zero(p)};
    if (scored.scores[i].visible) {
      spot.noticed = needed * scored.scores[i].stddev;
      spot.shifts = scored.test->calcShifts(static_cast<Index>(i), spot.noticed)
                        .head(p)
                        .cwiseQuotient(scored.stddevs.head(p));
    }
    spots.push_back(std::move(spot));
  }
  return spots;
}

std::vector<BlindSpot> calcBlindSpots(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                      double level) {
  requireKnownNoise(experiment, "what would go unnoticed");
  const VectorXd center = calcBoxCenter(collectUnknown(experiment.model));
  return calcBlindSpots(scoreCandidates(experiment, recordings, center),
                        static_cast<Index>(experiment.model.parameters.size()), level);
}

}  // namespace twinmap
