#pragma once

#include <vector>

#include "framework/estimation/refined/refined.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"

namespace twinmap {

/// The test samples, refined, and how that went.
struct RefinedTests {
  std::vector<Refined> refined;  ///< one for each sample; none where the experiment does not ask for it
  StageNotes notes;
};

/// Where the experiment asks for it, refines every test sample as `twinmap infer` does a measurement; a stage
/// of its own. Throws Interrupted where `control` abandons the run. Cost: some 10 to 60 simulations each,
/// more where the first start is not accepted.
RefinedTests refineTestSamples(const Study& study, const PreparedData& data, const OnlineModel& online);

}  // namespace twinmap
