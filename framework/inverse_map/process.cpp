#include "framework/inverse_map/process.hpp"

namespace twinmap {

double getNlml(const Process& process) {
  if (const auto* exact = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&process)) {
    return (*exact)->getNlml();
  }
  return std::get<std::shared_ptr<const gp::SparseGaussianProcess>>(process)->getParts().posterior.bound;
}

double getNoiseVariance(const Process& process) {
  const double stddev =
      std::visit([](const auto& trained) { return trained->getHyperparameters().noise_stddev; }, process);
  return stddev * stddev;
}

}  // namespace twinmap
