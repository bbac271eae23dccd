#pragma once

#include <vector>

#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// Compares windows of one record that were inferred one by one, in this order. Those count of which no
/// status misleads (misleads()). A parameter is constant over them. Of kFewestOfCourse that begin one after
/// another it goes as fitCourse() finds. Windows disagree where one scatters more about that than its
/// standard deviations say (calcScatterPValue() below kMismatchLevel over all parameters). Each that counts
/// then gets the scatter, and all starts to ask with. By chance two disagree in 15 of 1089 pairs (17
/// mechanisms, 12 recordings each). parameters: those of the machine.
void compareWindows(const std::vector<ParameterSpec>& parameters, std::vector<InferredMeasurement>& windows);

}  // namespace twinmap
