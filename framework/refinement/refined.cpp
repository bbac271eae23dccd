#include "framework/refinement/refined.hpp"

namespace twinmap {

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
