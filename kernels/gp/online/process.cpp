#include "kernels/gp/online/process.hpp"

namespace twinmap::gp {

double getNlml(const Process& process) {
  if (const auto* exact = std::get_if<std::shared_ptr<const GaussianProcess>>(&process)) {
    return (*exact)->getNlml();
  }
  return std::get<std::shared_ptr<const SparseGaussianProcess>>(process)->getParts().posterior.bound;
}

double getNoiseVariance(const Process& process) {
  const double stddev =
      std::visit([](const auto& trained) { return trained->getHyperparameters().noise_stddev; }, process);
  return stddev * stddev;
}

}  // namespace twinmap::gp
