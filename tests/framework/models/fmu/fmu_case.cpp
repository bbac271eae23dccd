#include "tests/framework/models/fmu/fmu_case.hpp"

#include "framework/models/fmu/package/package.hpp"
#include "framework/models/fmu/run/bind_variables.hpp"
#include "framework/models/fmu/run/runner.hpp"

namespace twinmap::testing {
namespace {

std::string toText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::vector<fmi::VariableUse> makeUses(const FmuCase& fmu, const std::vector<std::string>& names) {
  std::vector<fmi::VariableUse> uses;
  for (const std::string& name : names) {
    const auto unit = fmu.units.find(name);
    uses.push_back({name, unit == fmu.units.end() ? "" : unit->second, {}});
  }
  return uses;
}

template <class Items, class GetName>
std::vector<std::string> collectNames(const Items& items, const GetName& get_name) {
  std::vector<std::string> names;
  for (const auto& item : items) {
    names.push_back(get_name(item));
  }
  return names;
}

}  // namespace

std::string findFmu(const std::string& name) {
  return std::string(TWINMAP_TEST_FMUS) + "/" + name + ".fmu";
}

FmuResult simulate(const FmuCase& fmu, int runs) {
  const fmi::Package package(findFmu(fmu.name));
  const fmi::ModelDescription& description = package.getDescription();
  fmi::RunSetting setting;
  setting.kind = fmu.kind;
  setting.parameters = fmi::bindParameters(
      description, makeUses(fmu, collectNames(fmu.parameters, [](const auto& item) { return item.first; })));
  setting.inputs = fmi::bindInputs(
      description,
      makeUses(fmu, collectNames(fmu.excitation, [](const auto& signal) { return signal.name.text; })));
  setting.outputs = fmi::bindOutputs(description, makeUses(fmu, fmu.outputs));
  setting.times = fmu.times;
  setting.duration = fmu.duration;
  setting.step = fmu.step;
  fmi::Runner runner(
      {description, fmu.kind, package.requireLibrary(fmu.kind), package.getFolder() / "resources"}, setting,
      static_cast<int>(fmu.excitation.size()));
  const ModelSpec nothing_named;
  ModelNumbers numbers(nothing_named);
  Excitation excitation(fmu.excitation);
  excitation.update(numbers);
  std::vector<double> values;
  for (const auto& [name, value] : fmu.parameters) {
    values.push_back(value);
  }
  FmuResult result{{}, Eigen::MatrixXd(fmu.times.size(), static_cast<Eigen::Index>(fmu.outputs.size()))};
  for (int i = 0; i < runs; ++i) {
    fmi::IntegrationPath own_steps;
    result.status = runner.run(values.data(), excitation, result.outputs.reshaped(), own_steps);
  }
  return result;
}

SignalSpec makePulse(const std::string& name, const std::string& unit, double value, double start,
                     double end) {
  SignalSpec signal;
  signal.name.text = name;
  signal.unit = unit;
  signal.pulses.push_back({{toText(value), {}}, {toText(start), {}}, {toText(end), {}}});
  return signal;
}

}  // namespace twinmap::testing
