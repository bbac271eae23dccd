#include <cmath>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"

namespace twinmap {

std::string makeDiagnosisCsv(const Diagnosis& diagnosis, const std::string& source) {
  std::vector<CsvRow> rows{{"source", "step", "rank", "of", "term", "size", "sd", "unit", "own_scale",
                            "own_scale_unit", "z", "p_value", "share", "log_evidence", "fitted", "status"}};
  for (std::size_t s = 0; s < diagnosis.steps.size(); ++s) {
    const DiagnosisStep& step = diagnosis.steps[s];
    for (std::size_t i = 0; i < step.ranked.size(); ++i) {
      const TermFinding& one = step.ranked[i];
      const bool has_scale = !one.candidate.own_scales.empty();
      rows.push_back({source, std::to_string(s + 1), std::to_string(i + 1), getName(one.candidate.place),
                      one.candidate.term, toText(one.estimate), toText(one.stddev), one.candidate.unit,
                      has_scale ? toText(one.candidate.own_scales.front().value) : "",
                      has_scale ? one.candidate.own_scales.front().unit : "", toText(one.z),
                      toText(one.p_value), toText(one.share), toText(one.log_evidence),
                      one.fitted ? "yes" : "no",
                      !step.found     ? ""
                      : i == 0        ? "found"
                      : i < step.tied ? "tied"
                                      : ""});
    }
  }
  return makeCsv(rows);
}

std::string makeBlindSpotCsv(const std::vector<BlindSpot>& spots,
                             const std::vector<ParameterSpec>& parameters) {
  CsvRow header{"term", "own_scale", "own_scale_unit", "noticed_from", "unit"};
  for (const ParameterSpec& parameter : parameters) {
    header.push_back("shift_" + parameter.name.text);
  }
  std::vector<CsvRow> rows{header};
  for (const BlindSpot& spot : spots) {
    const bool has_scale = !spot.candidate.own_scales.empty(), is_seen = std::isfinite(spot.noticed);
    rows.push_back({spot.candidate.term, has_scale ? toText(spot.candidate.own_scales.front().value) : "",
                    has_scale ? spot.candidate.own_scales.front().unit : "",
                    is_seen ? toText(spot.noticed) : "", spot.candidate.unit});
    for (const double shift : spot.shifts) {
      rows.back().push_back(is_seen ? toText(shift) : "");
    }
  }
  return makeCsv(rows);
}

}  // namespace twinmap
