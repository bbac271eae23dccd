#include "framework/models/mechanism/recorded_parameters.hpp"

#include "framework/experiment/model/curve.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

NamedValues<program::Symbol> recordParameters(const ModelSpec& model, program::Recorder& recorder) {
  NamedValues<program::Symbol> names;
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    names.set(sampled[i].name.text, recorder.parameter(static_cast<int>(i)));
  }
  for (const ConstantSpec& constant : model.constants) {
    names.set(constant.name.text, names.calc(constant.value));
  }
  defineCurves(model.system.curves, names);
  return names;
}

}  // namespace twinmap
