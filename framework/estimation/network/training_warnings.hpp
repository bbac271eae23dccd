#pragma once

#include <string>
#include <vector>

#include "framework/estimation/network/network_map_training.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What a person should know of a training, added to its warnings.

/// Says that the training went back to a checkpoint so many times, if it did.
void warnOfRestarts(int restarts, std::vector<std::string>& warnings);

/// Says where the chains of a sampler do not agree, or cannot have seen all of the posterior.
void warnOfChains(const WeightChains& chains, std::vector<std::string>& warnings);

/// Names the parameters whose smallest 50 % or 95 % sets hold another share of the samples held out: their
/// answers are not of the kind that the network gives, a normal distribution or a mixture. Cost: of a mixture
/// some 0.1 ms a sample held out and parameter.
void warnOfShape(const std::vector<ParameterSpec>& parameters, NetworkMapTraining& training);

}  // namespace twinmap
