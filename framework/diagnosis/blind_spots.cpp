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

VectorXd keepWithinBounds(const VectorXd& shifts, const ScoredCandidates& scored,
                          const std::vector<ParameterSpec>& parameters) {
  const VectorXd most = calcWidths(parameters).cwiseQuotient(scored.stddevs.head(shifts.size()));
  return (shifts.array().abs() > most.array()).select(0.0, shifts);
}

std::vector<BlindSpot> calcBlindSpots(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                      double level) {
  requireKnownNoise(experiment, "what would go unnoticed");
  const VectorXd center = calcBoxCenter(collectUnknown(experiment.model));
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  const ScoredCandidates scored = scoreCandidates(experiment, recordings, center);
  std::vector<BlindSpot> spots = calcBlindSpots(scored, static_cast<Index>(parameters.size()), level);
  for (BlindSpot& spot : spots) {
    spot.shifts = keepWithinBounds(spot.shifts, scored, parameters);
  }
  return spots;
}

}  // namespace twinmap
