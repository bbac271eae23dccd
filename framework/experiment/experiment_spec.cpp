#include "framework/experiment/experiment_spec.hpp"

#include "framework/experiment/model/elements/force_elements.hpp"

// Copies and destructors of specs that most of the framework handles: compiled in every unit they took a
// tenth of the build.
namespace twinmap {

SignalSpec::SignalSpec() = default;
SignalSpec::SignalSpec(const SignalSpec&) = default;
SignalSpec::SignalSpec(SignalSpec&&) noexcept = default;
SignalSpec& SignalSpec::operator=(const SignalSpec&) = default;
SignalSpec& SignalSpec::operator=(SignalSpec&&) noexcept = default;
SignalSpec::~SignalSpec() = default;

SystemSpec::SystemSpec() = default;
SystemSpec::SystemSpec(const SystemSpec&) = default;
SystemSpec::SystemSpec(SystemSpec&&) noexcept = default;
SystemSpec& SystemSpec::operator=(const SystemSpec&) = default;
SystemSpec& SystemSpec::operator=(SystemSpec&&) noexcept = default;
SystemSpec::~SystemSpec() = default;

ModelSpec::ModelSpec() = default;
ModelSpec::ModelSpec(const ModelSpec&) = default;
ModelSpec::ModelSpec(ModelSpec&&) noexcept = default;
ModelSpec& ModelSpec::operator=(const ModelSpec&) = default;
ModelSpec& ModelSpec::operator=(ModelSpec&&) noexcept = default;
ModelSpec::~ModelSpec() = default;

ExperimentSpec::ExperimentSpec() = default;
ExperimentSpec::ExperimentSpec(const ExperimentSpec&) = default;
ExperimentSpec::ExperimentSpec(ExperimentSpec&&) noexcept = default;
ExperimentSpec& ExperimentSpec::operator=(const ExperimentSpec&) = default;
ExperimentSpec& ExperimentSpec::operator=(ExperimentSpec&&) noexcept = default;
ExperimentSpec::~ExperimentSpec() = default;

}  // namespace twinmap
