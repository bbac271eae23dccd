#pragma once

#include "kernels/online/process.hpp"

namespace twinmap {

using gp::Process;

/// Its negative log marginal likelihood, or the variational bound on it from above; nats.
double getNlml(const Process& process);

/// Its likelihood's noise variance, in the standardised parameter.
double getNoiseVariance(const Process& process);

}  // namespace twinmap
