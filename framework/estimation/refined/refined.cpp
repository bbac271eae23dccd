#include "framework/estimation/refined/refined.hpp"

#include <limits>

namespace twinmap {

double Refined::calcReducedChiSquare() const {
  return degrees > 0.0 ? chi_square / degrees : std::numeric_limits<double>::infinity();
}

void rejectAsMultimodal(Refined& refined) {
  if (refined.isAccepted()) {
    refined.status = RefinementStatus::kMultimodal;
    refined.message = "other values of the parameters fit the measurement as well";
    refined.covariance.resize(0, 0);
    refined.mean.resize(0);
    refined.stddev.resize(0);
    refined.ridge = {};
    refined.interval_factors = {};
  }
}

const char* toString(RefinementStatus status) {
  switch (status) {
    case RefinementStatus::kAccepted:
      return "accepted";
    case RefinementStatus::kMisfit:
      return "misfit";
    case RefinementStatus::kNonlinear:
      return "nonlinear";
    case RefinementStatus::kMultimodal:
      return "multimodal";
    case RefinementStatus::kFailed:
      break;
  }
  return "failed";
}

}  // namespace twinmap
