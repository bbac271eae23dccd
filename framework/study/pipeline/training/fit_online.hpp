#pragma once

#include <memory>

#include "framework/estimation/trained/online_model.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"

namespace twinmap {

/// An online model; a note says why it has no trust model where it has none.
struct OnlineFit {
  OnlineModel model;
  StageNotes notes{};
};

/// Of how many simulated measurements a trust model's references are made: as fine as the map and the level
/// of false alarms deserve.
int countReferences(const ExperimentSpec& experiment);

/// Fits an estimator's trust model: a forward surrogate to the clean responses of at most the first 500
/// training samples (its size and the time of a judgement grow with their number squared), where neither
/// `forward` is one that it learnt from nor it has one of its own (Estimator::findForward); the reference
/// distributions to 1000 simulated measurements (fewer below 100 training samples) or as many as there are
/// test responses, up to 2000 at a level of 1 % of false alarms: test responses with noise drawn for that
/// alone. Does not depend on the threads. Cost: that of fitForward() and some 2000 inferences of some ms.
/// Throws Interrupted.
OnlineFit fitOnline(const Study& study, const PreparedData& data, std::shared_ptr<const Estimator> map,
                    std::shared_ptr<const ForwardSurrogate> forward = nullptr);

}  // namespace twinmap
