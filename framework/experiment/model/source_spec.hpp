#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

enum class FmuKind { kCoSimulation, kModelExchange };

template <>
struct EnumNames<FmuKind> {
  static constexpr EnumName<FmuKind> values[] = {{"co_simulation", FmuKind::kCoSimulation},
                                                 {"model_exchange", FmuKind::kModelExchange}};
};

/// A model that comes as a Functional Mock-up Unit (docs/how-to/use-an-fmu.md).
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

/// A variable of a program's environment.
struct EnvironmentSpec {
  Name name;
  std::string value;
};

template <class Fields>
void describe(Fields& f, EnvironmentSpec& s) {
  f.scalarIsValueOf("value");
  f.required("value", s.value, "text");
}

/// A model that is a program, started once and kept: lines of JSON in, lines of JSON out
/// (docs/how-to/use-a-program.md).
struct ProgramSpec {
  std::vector<std::string> command;           ///< the program, found as a shell finds it, and its arguments
  std::string working_folder;                 ///< absolute once read; the experiment file's by default
  std::vector<EnvironmentSpec> environment;   ///< beside twinmap's own
  std::vector<std::string> depends_on;        ///< files, relative to working_folder
  std::optional<int> workers;                 ///< none: one a thread
  double start_timeout = 60.0;                ///< s until it has answered the handshake
  double timeout = 60.0;                      ///< s a sample
  int batch = 1;                              ///< samples a request
  std::optional<double> excitation_interval;  ///< s; none: the excitation is sampled where the outputs are
  double memory = 4.0;                        ///< GiB of address space for each of its processes
};

template <class Fields>
void describe(Fields& f, ProgramSpec& s) {
  f.required("command", s.command, "the program and its arguments, started without a shell");
  f.optional("working_folder", s.working_folder,
             "where it runs, relative to the experiment file, whose folder it is by default");
  f.optionalMap("environment", s.environment, "variables of its environment, beside twinmap's own");
  f.optional(
      "depends_on", s.depends_on,
      "files that it reads, relative to working_folder: where one changes, samples are simulated anew");
  f.optional("workers", s.workers, "how many of it run at once; default: one a thread", kThousand);
  f.optional("start_timeout", s.start_timeout, "until it has answered the handshake; s", kPositive);
  f.optional("timeout", s.timeout, "a sample; more is a failure; s", kPositive);
  f.optional("batch", s.batch, "samples in one request, for programs that vectorise", kHundredThousand);
  f.optional("excitation_interval", s.excitation_interval,
             "how finely the excitation is sampled for it; default: at the times of the outputs; s",
             kSampleInterval);
  f.optional("memory", s.memory, "address space of each of its processes; GiB", kPositive);
  f.rule(!s.command.empty() && !s.command.front().empty(), "must name a program in 'command'");
}

/// A model that is not described in the experiment file.
struct SourceSpec {
  std::optional<FmuSpec> fmu;
  std::optional<ProgramSpec> program;
};

template <class Fields>
void describe(Fields& f, SourceSpec& s) {
  f.oneOf("must give exactly one of", choice("fmu", s.fmu, "a Functional Mock-up Unit"),
          choice("program", s.program, "a program of any language"));
}

}  // namespace twinmap
