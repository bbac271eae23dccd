#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/blind_spots.hpp"
#include "framework/diagnosis/diagnosis.hpp"

namespace twinmap {

/// "chi-square 210 of 197 degrees of freedom, explained by the noise".
std::string describeFit(const ExplainedFit& fit);

/// The same of the model before any term, which noise may explain though a term stands out.
std::string describeBefore(const Diagnosis& diagnosis);

/// "Noise as the residual has it: sd 0.0002 (x)", of outputs whose noise is unknown; "" without such.
std::string describeNoise(const Diagnosis& diagnosis);

/// "The best fit lies at the bounds of k: ..."; "" where it does not.
std::string describeBounds(const Diagnosis& diagnosis);

/// What a step found, in lines. level: Diagnosis::level.
std::string describeStep(const DiagnosisStep& step, std::size_t number, double level);

/// "What remains is as a force on x of sd 0.03 N, ...".
std::string describeRemainder(const Diagnosis& diagnosis);

/// "A random process explains more than all terms found: it is as a force on x of sd ..."; where one does.
std::string describeProcess(const Diagnosis& diagnosis);

/// Headings, then rows of cells.
using TextRows = std::vector<std::vector<std::string>>;

/// The terms that are tied, and some of those behind them.
TextRows listTermRows(const DiagnosisStep& step, const std::vector<ParameterSpec>& parameters);

/// The parameters before and after, and those of the terms.
TextRows listParameterRows(const Diagnosis& diagnosis);

/// The machine's parameters with a process; empty where it moves one out of its bounds.
TextRows listRemainderRows(const Remainder& remainder, const std::vector<ParameterSpec>& parameters);

/// For people: how well the model explains the recordings, each term that was found with its rivals, the
/// parameters before and after, what remains. source: names the recordings.
std::string makeDiagnosisTable(const Diagnosis& diagnosis, const std::string& source);

/// CSV: a row for each candidate of each step, and its header.
std::string makeDiagnosisCsv(const Diagnosis& diagnosis, const std::string& source);

/// One line of JSON, without a line end.
std::string makeDiagnosisJson(const Diagnosis& diagnosis, const std::string& source);

/// The same of blind spots; `parameters`: those of the machine.
std::string makeBlindSpotTable(const std::vector<BlindSpot>& spots,
                               const std::vector<ParameterSpec>& parameters);
std::string makeBlindSpotCsv(const std::vector<BlindSpot>& spots,
                             const std::vector<ParameterSpec>& parameters);
std::string makeBlindSpotJson(const std::vector<BlindSpot>& spots,
                              const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
