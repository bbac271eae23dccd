#include "framework/models/fmu/worker_job.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/tree/read_value.hpp"
#include "tests/framework/models/fmu/fmu_case.hpp"

namespace twinmap::testing {
namespace {

using namespace fmi;

/// A model of the two beams whose parameter `strange`, of which the FMU knows nothing, stands in one signal.
ModelSpec makeModel(const std::string& signal) {
  const YamlNode node = parseYaml(signal, "a signal");
  ModelSpec model;
  model.excitation.emplace_back();
  FieldReader fields(node);
  describe(fields, model.excitation.front());
  fields.finish();
  model.excitation.front().name.text = "F";
  model.parameters.emplace_back();
  model.parameters.front().name.text = "strange";
  model.source.emplace();
  model.source->fmu.emplace();
  return model;
}

TEST(WorkerJob, AParameterOfTheExcitationNeedNotBeTheFmus) {
  const Package package(findFmu("two_beam_3"));
  const auto count_bound = [&](const std::string& signal) {
    return makeRunSetting(package.getDescription(), Kind::kModelExchange, makeModel(signal), {1.0})
        .parameters.slots.size();
  };
  for (const char* kind :
       {"pulses: [{amplitude: 1, start: 1, end: 1}]",
        "sines: [{amplitude: 1, frequency: 1, phase: 1, start: 1, end: 1}]",
        "chirps: [{amplitude: 1, start_frequency: 1, end_frequency: 1, start: 1, end: 1}]",
        "multisines: [{amplitude: 1, frequencies: [1, 1], phases: [1, 1], start: 1, end: 1}]",
        "multisines: [{amplitudes: [1, 1], frequencies: [2, 3]}]"}) {
    const std::string text = kind;
    EXPECT_THROW(count_bound(text), ExperimentError) << text;
    for (std::size_t at = text.find('1'); at != std::string::npos; at = text.find('1', at + 1)) {
      std::string used = text;
      EXPECT_EQ(count_bound(used.replace(at, 1, "2*strange")), 0U) << used;
    }
  }
}

}  // namespace
}  // namespace twinmap::testing
