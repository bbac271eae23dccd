#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/replace_name.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {

namespace {

TermCandidate makeOwnCandidate(const CandidateSpec& spec) {
  TermCandidate candidate;
  candidate.term = spec.name.text;
  candidate.meaning = spec.description.empty()
                          ? fmt::format("force c*({}) on {}", spec.force.text, spec.coordinate.text)
                          : spec.description;
  candidate.unit = spec.unit;
  if (spec.scale) {
    candidate.own_scales = {{spec.scale->name.text, spec.scale->unit}};
  }
  candidate.add = [spec](ModelSpec& model, const std::string& coefficient,
                         const std::vector<std::string>& scales) {
    ForceLaw<Expression> law;
    law.coordinate = spec.coordinate;
    const std::string force =
        spec.scale ? replaceName(spec.force.text, spec.scale->name.text, scales.front()) : spec.force.text;
    law.force = {coefficient + "*(" + force + ")", spec.force.where};
    model.system.elements.get<ForceLaw>().push_back(law);
  };
  return candidate;
}

}  // namespace

std::vector<TermCandidate> listOwnCandidates(const std::vector<CandidateSpec>& candidates,
                                             const ModelSizes& sizes) {
  std::vector<TermCandidate> listed;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const CandidateSpec& spec = candidates[i];
    const auto coordinate =
        std::find_if(sizes.coordinates.begin(), sizes.coordinates.end(),
                     [&](const CoordinateSizes& one) { return one.name == spec.coordinate.text; });
    for (std::size_t k = 0; k < sizes.own_forces[i].size(); ++k) {
      const double force = sizes.own_forces[i][k];
      if (coordinate == sizes.coordinates.end() || !(force > 0.0)) {
        continue;  // nothing moves, or the force is 0 all the time
      }
      TermCandidate candidate = makeOwnCandidate(spec);
      candidate.size = coordinate->force / force;
      if (spec.scale) {
        candidate.own_scales.front().value = spec.scale->values[k];
      }
      listed.push_back(std::move(candidate));
    }
  }
  return listed;
}

}  // namespace twinmap
