#pragma once

#include <vector>

#include "framework/simulation/excitation/excitation.hpp"

namespace twinmap {

/// Appends the terms of one signal, evaluated at the current parameter set. A table becomes one line per
/// interval, a cubic one its spline, which must outlive the terms. Throws SimulationFailure as
/// Excitation::update does.
void appendTerms(const SignalSpec& spec, int signal, const TableSplines& splines, NumberEvaluator& numbers,
                 std::vector<ExcitationTerm>& terms);

/// Schroeder's phases -pi k (k - 1) / N, k = 1..N, in rad: a low crest factor for equal amplitudes.
std::vector<double> calcSchroederPhases(int count);

}  // namespace twinmap
