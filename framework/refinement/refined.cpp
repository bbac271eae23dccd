#include "framework/refinement/refined.hpp"

#include <limits>

namespace twinmap {

double Refined::calcReducedChiSquare() const {
  return degrees > 0.0 ? chi_square / degrees : std::numeric_limits<double>::infinity();
}

const char* toString(RefinementStatus status) {
  switch (status) {
    case RefinementStatus::kAccepted:
      return "accepted";
    case RefinementStatus::kMisfit:
      return "misfit";
    case RefinementStatus::kNonlinear:
      return "nonlinear";
    case RefinementStatus::kFailed:
      break;
  }
  return "failed";
}

}  // namespace twinmap
