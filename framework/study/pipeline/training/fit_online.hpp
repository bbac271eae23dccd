#pragma once

#include <memory>

#include "framework/estimation/trained/online_model.hpp"
#include "framework/study/pipeline/prepare_data.hpp"

namespace twinmap {

/// An online model; a note says why it has no trust model where it has none.
struct OnlineFit {
  OnlineModel model;
  StageNotes notes{};
};

/// Of how many simulated measurements a trust model's references are made: as fine as the map deserves.
int countReferences(int train_samples);

/// Compresses a map of processes and fits its trust model: a forward surrogate to the clean responses of at
/// most the first 500 training samples (its size and the time of a judgement grow with their number squared),
/// the reference distributions to 1000 simulated measurements (fewer below 100 training samples) or as many
/// as there are test responses, up to 2000 at a level of 1 % of false alarms: test responses with noise drawn
/// for that alone. Does not depend on the threads. Cost: that of fitForward() and some 2000 inferences of
/// some ms. Throws Interrupted.
OnlineFit fitOnline(const Study& study, const PreparedData& data, const GpMap& map);

/// The same of a surrogate, which is its own trust model's.
OnlineFit fitOnline(const Study& study, const PreparedData& data, std::shared_ptr<const Surrogate> surrogate);

/// The same of a network. `forward`: a surrogate that it learnt from, which is then the trust model's; null
/// to fit one.
OnlineFit fitOnline(const Study& study, const PreparedData& data, std::shared_ptr<const NetworkMap> map,
                    std::shared_ptr<const ForwardSurrogate> forward);

}  // namespace twinmap
