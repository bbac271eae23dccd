#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace twinmap::fmi {

enum class Version { k2, k3 };
enum class Kind { kCoSimulation, kModelExchange };

/// FMI 2.0 has kFloat64 (Real), kInt32 (Integer), kBoolean, kString and kEnumeration.
enum class Type {
  kFloat64,
  kFloat32,
  kInt8,
  kUInt8,
  kInt16,
  kUInt16,
  kInt32,
  kUInt32,
  kInt64,
  kUInt64,
  kBoolean,
  kEnumeration,
  kString,
  kBinary,
  kClock
};
enum class Causality {
  kParameter,
  kCalculatedParameter,
  kStructuralParameter,
  kInput,
  kOutput,
  kLocal,
  kIndependent,
  kDependent
};
enum class Variability { kConstant, kFixed, kTunable, kDiscrete, kContinuous };
/// Where the value at the start comes from; kNone: of inputs and of the independent variable.
enum class Initial { kExact, kApprox, kCalculated, kNone };

/// The words of the standard, as in the model description.
const char* toText(Type type);
const char* toText(Causality causality);
const char* toText(Variability variability);
const char* toText(Kind kind);

/// Values that this interface exchanges as numbers.
bool isNumeric(Type type);

/// A variable of the model description.
struct Variable {
  std::string name, description, unit;
  std::uint32_t reference = 0;
  Type type = Type::kFloat64;
  Causality causality = Causality::kLocal;
  Variability variability = Variability::kContinuous;
  Initial initial = Initial::kCalculated;
  std::string start;  ///< as written; of an array, its elements in row-major order, or one for all of them
  std::optional<double> minimum, maximum, nominal;
  bool relative_quantity = false;       ///< units are converted without their offset
  std::vector<std::size_t> dimensions;  ///< empty: a scalar; the sizes that the start values give
  bool timed_clock = false;             ///< an input clock whose ticks the FMU asks for at times
  int derivative_of = -1;               ///< index of the state that this is the derivative of; -1: none

  std::size_t getSize() const;
};

/// value in SI = factor * value + offset, where SI is the product of the base units' powers.
struct BaseUnit {
  static constexpr std::array<const char*, 8> kNames{"kg", "m", "s", "A", "K", "mol", "cd", "rad"};
  std::array<int, 8> exponents{};
  double factor = 1.0, offset = 0.0;
};

/// What one kind of an FMU can do.
struct Capabilities {
  std::string model_identifier;
  std::vector<std::string> source_files;  ///< FMI 2.0; relative to sources/
  bool needs_execution_tool = false;
  bool can_be_instantiated_only_once = false;
  bool variable_step = false;           ///< canHandleVariableCommunicationStepSize
  std::optional<double> internal_step;  ///< s; fixedInternalStepSize (FMI 3.0)
  bool might_return_early = false;      ///< mightReturnEarlyFromDoStep (FMI 3.0)
  bool event_mode = false;              ///< hasEventMode (FMI 3.0), of Co-Simulation
  bool needs_completed_integrator_step = true;
  bool directional_derivatives = false;
};

struct DefaultExperiment {
  std::optional<double> start, stop, tolerance, step;
};

/// modelDescription.xml of an FMU.
struct ModelDescription {
  Version version = Version::k2;
  std::string version_text, model_name, token;  ///< token: the GUID of FMI 2.0
  std::string generation_tool, description;
  std::optional<Capabilities> co_simulation, model_exchange;
  DefaultExperiment default_experiment;
  std::map<std::string, std::optional<BaseUnit>> units;  ///< none: a unit without its base units
  std::vector<Variable> variables;
  std::vector<int> state_derivatives;  ///< indices of variables
  std::size_t event_indicators = 0;
  /// FMI 3.0: what outputs and state derivatives are said to depend on; value references.
  std::set<std::uint32_t> dependencies;
  std::vector<std::string> log_categories;

  const Capabilities& getCapabilities(Kind kind) const;
  /// The first input clock that follows the time; null if there is none.
  const Variable* findTimedClock() const;
};

/// Reads modelDescription.xml of FMI 2.0 or 3.0. `file_name` is what messages call it. Throws ExperimentError
/// for XML that does not parse, another version of FMI, and what the standard demands and is not there.
ModelDescription readModelDescription(const std::filesystem::path& xml, const std::string& file_name);

}  // namespace twinmap::fmi
