#pragma once

#include <optional>

#include "framework/spec/expression/expression.hpp"
#include "framework/spec/fields/fields.hpp"
#include "framework/spec/fields/one_of.hpp"

namespace twinmap {

enum class FmuKind { kCoSimulation, kModelExchange };

template <>
struct EnumNames<FmuKind> {
  static constexpr EnumName<FmuKind> values[] = {{"co_simulation", FmuKind::kCoSimulation},
                                                 {"model_exchange", FmuKind::kModelExchange}};
};

/// A model that comes as a Functional Mock-up Unit (docs/fmu.md).
struct FmuSpec {
  Name file;                    ///< relative to the experiment file
  std::optional<FmuKind> kind;  ///< none: what the FMU has, co-simulation if both
  std::optional<double> step;   ///< s, the largest communication step; none: as the FMU suggests
  double memory = 4.0;          ///< GiB of address space for each of its processes
};

template <class Fields>
void describe(Fields& f, FmuSpec& s) {
  f.required("file", s.file, "an FMU of FMI 2.0 or 3.0; relative to the experiment file");
  f.optional("kind", s.kind, "default: what the FMU has; of both, co_simulation");
  f.optional("step", s.step, "largest communication step; default: as the FMU suggests; s", kPositive);
  f.optional("memory", s.memory, "address space of each of its processes; GiB", kPositive);
}

/// A model that is not described in the experiment file.
struct SourceSpec {
  std::optional<FmuSpec> fmu;
};

template <class Fields>
void describe(Fields& f, SourceSpec& s) {
  f.oneOf("must give exactly one of", choice("fmu", s.fmu, "a Functional Mock-up Unit"));
}

}  // namespace twinmap
