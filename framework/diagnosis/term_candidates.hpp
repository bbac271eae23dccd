#pragma once

#include <vector>

#include "framework/diagnosis/model_sizes.hpp"
#include "framework/diagnosis/term_candidate.hpp"

namespace twinmap {

/// Forces on each coordinate (damping, friction, springs, stops, a constant force) and between two of a kind.
std::vector<TermCandidate> listForceCandidates(const ModelSizes& sizes);

/// Mass, centre of mass and moments of inertia of each body; gravity in another direction.
std::vector<TermCandidate> listBodyCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Offset and gain of each output; gain and delay of each signal.
std::vector<TermCandidate> listSignalCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// All of them, those with a scale of their own once for each value of a grid.
std::vector<TermCandidate> listCandidates(const ModelSpec& model, const ModelSizes& sizes);

/// Multiplies every signal, wherever forces use it.
void scaleSignals(ModelSpec& model, double factor);

/// Replaces a name of an expression, wherever it stands as a whole word: "x - x0", "x" by "(2*x)" is
/// "(2*x) - x0".
std::string replaceName(const std::string& text, const std::string& name, const std::string& replacement);

}  // namespace twinmap
