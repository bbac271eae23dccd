#include "framework/estimation/estimation_method.hpp"

namespace twinmap {

const char* toString(EstimationMethod method) {
  switch (method) {
    case EstimationMethod::kGp:
      return "gp";
    case EstimationMethod::kSurrogate:
      return "surrogate";
    case EstimationMethod::kNetwork:
      return "network";
    case EstimationMethod::kRefined:
      break;
  }
  return "refined";
}

}  // namespace twinmap
