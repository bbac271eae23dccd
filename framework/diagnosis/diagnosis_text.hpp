#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/blind_spots.hpp"
#include "framework/diagnosis/diagnosis.hpp"

namespace twinmap {

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
