#include "framework/inference/stated_prior.hpp"

#include "framework/estimation/box_prior.hpp"
#include "framework/experiment/points/prior_text.hpp"

namespace twinmap {

std::shared_ptr<const StatedPrior> findStatedPrior(const ModelSpec& model) {
  const std::shared_ptr<const Prior> prior = findPrior(model);
  return prior ? std::make_shared<const StatedPrior>(StatedPrior{describePriors(model), prior->calcStddevs()})
               : nullptr;
}

}  // namespace twinmap
