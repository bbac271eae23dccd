#pragma once

#include <vector>

#include "framework/diagnosis/candidates/model_sizes.hpp"
#include "framework/diagnosis/candidates/term_candidate.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Of the duration: what recordings are read beside it, and signals go on by, for the delays that are tried.
constexpr double kDelayMargin = 0.25;

/// Sizes of coefficients that are large: a share of what a gain, a mass or an offset is of; of the duration,
/// a delay; and the shortest lag that is scanned. Of gravity rad, which a spirit level shows at once; of a
/// clock; of a contact's power, as spheres have 1.5 in the place of 1.
constexpr double kLargeShare = 0.1, kLongDelay = 0.005, kShortestLag = 0.002, kLargeTilt = 0.02,
                 kLargeDrift = 0.01, kHertz = 0.5;

/// OwnScale::reach of what is limited: a limit near 0 would be a gain with a step at 0, a dead zone as wide
/// as the signal a gain.
constexpr double kReachOfLimits = 2.0;

/// Forces on each coordinate (damping, friction, springs, stops, a constant force) and between two of a kind.
std::vector<TermCandidate> listForceCandidates(const ModelSizes& sizes);

/// Friction that grows with what each coordinate carries: gravity, and what its force laws say of coordinates
/// (load). And with what drives it: what they say of signals, states and controllers. Both raise the level of
/// the model's friction, where there is one.
std::vector<TermCandidate> listLoadCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Forces with states on each coordinate: friction that is a spring before it slips, hysteresis, a mass on a
/// spring.
std::vector<TermCandidate> listMemoryCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Other laws in the place of each friction element of the model: by a speed over which it sets in, and by
/// bristles.
std::vector<TermCandidate> listLawCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Another power of the depth, and more loss of energy, of each contact: elastic stops, play, points on
/// planes.
std::vector<TermCandidate> listContactCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Another place and speed of each coordinate at the start, where these are not unknown anyway.
std::vector<TermCandidate> listStartCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Mass, centre of mass and moments of inertia of each body; gravity in another direction.
std::vector<TermCandidate> listBodyCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Offset, gain, drift, delay, lag, clipping and cross-talk of outputs, and the clock by which they are
/// recorded.
std::vector<TermCandidate> listOutputCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Gain, delay, lag, dead zone and clipping of each signal; of tables, that their values are held.
std::vector<TermCandidate> listSignalCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Those that the experiment names (CandidateSpec).
std::vector<TermCandidate> listOwnCandidates(const std::vector<CandidateSpec>& candidates,
                                             const ModelSizes& sizes);

/// All of them, those with a scale of their own once for each value of a grid.
std::vector<TermCandidate> listCandidates(const ExperimentSpec& experiment, const ModelSizes& sizes);

/// Those of an experiment that combines trials, each once, with the sizes of every trial: a coordinate's are
/// the largest, so that all trials scan the same scales.
std::vector<TermCandidate> listTrialCandidates(const ExperimentSpec& combined, std::vector<ModelSizes> sizes);

/// Once for each value of its first own scale, from `first` on, each `factor` times the one before.
void addScanned(const TermCandidate& candidate, double first, double factor, int count,
                std::vector<TermCandidate>& candidates);

/// The same of a limit: values from `first` times the least extent to `last` times the largest, by a factor
/// of at most `factor`.
void addLimits(const TermCandidate& candidate, const Extent& extent, double first, double last, double factor,
               std::vector<TermCandidate>& candidates);

/// Adds a force law on a coordinate to a model.
void addForceLaw(ModelSpec& model, const std::string& coordinate, const std::string& force);

/// The unit of a coordinate, "rad" or "m".
std::string getLength(const CoordinateSizes& coordinate);

/// What of a value lies beyond -limit ... limit, as an expression.
std::string writeBeyond(const std::string& value, const std::string& limit);

/// Adds a state to a model, the last one, whose rate is still 0; returns its name, `name` where that is not
/// taken.
std::string addState(ModelSpec& model, const std::string& name, const std::string& initial,
                     const std::string& unit);

/// The initial value of a coordinate or a speed, as an expression.
std::string findInitial(const std::vector<NamedExpression>& initial, const std::string& name);

/// Multiplies every signal, wherever forces use it.
void scaleSignals(ModelSpec& model, double factor);

}  // namespace twinmap
