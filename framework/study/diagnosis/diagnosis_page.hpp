#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/diagnosis.hpp"

namespace twinmap {

/// The names of recordings, as readRecordings() orders them: of windows that start at `starts` in each file.
std::vector<std::string> nameRecordings(const std::vector<std::string>& files,
                                        const std::vector<double>& starts);

/// One self-contained page: the status, the forces that are missing from the model as the recordings have
/// them, the residuals, the terms and the parameters. names: of the recordings, the first twelve of which are
/// drawn. Throws std::runtime_error where the fit cannot be simulated again. Cost: as of
/// estimateUnknownForces().
std::string makeDiagnosisPage(const Diagnosis& diagnosis, const ExperimentSpec& experiment,
                              const RecordedFeatures& recordings, const std::vector<std::string>& names);

}  // namespace twinmap
