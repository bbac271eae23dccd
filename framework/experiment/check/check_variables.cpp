#include "framework/experiment/check/check_variables.hpp"

#include <filesystem>

#include "framework/experiment/check/check_scope.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

void checkSourceFiles(const SourceSpec& source, const std::string& experiment) {
  std::error_code ignored;
  if (source.fmu && !std::filesystem::is_regular_file(source.fmu->file.text, ignored)) {
    throw ExperimentError(source.fmu->file.where, source.fmu->file.text, "is not a file");
  }
  if (!source.program) {
    return;
  }
  const std::filesystem::path folder = source.program->working_folder;
  const SourceLocation where{experiment, 0, 0, "model.program"};
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw ExperimentError(where, folder.string(), "is not a folder");
  }
  for (const std::string& file : source.program->depends_on) {
    if (!std::filesystem::is_regular_file(folder / file, ignored)) {
      throw ExperimentError(where, file, "is not a file that it could depend on");
    }
  }
}

}  // namespace

void checkVariables(const ModelSpec& model) {
  const bool elsewhere = model.source.has_value();
  for (const OutputSpec& output : model.outputs) {
    if (output.variable.has_value() != elsewhere) {
      throw ExperimentError(output.name.where, output.name.text,
                            elsewhere ? "must give the variable of the model that it is"
                                      : "is a variable, which only an FMU or a program has");
    }
    if (!elsewhere && output.expression.text.empty() && !output.unit.empty()) {
      throw ExperimentError(output.name.where, output.name.text,
                            "has the unit of what it measures; state none");
    }
    CheckScope::readUnit(output.unit, output.name.where);
  }
  const auto refuse = [&](const auto& items) {
    for (const auto& item : items) {
      if (item.variable && !elsewhere) {
        throw ExperimentError(item.variable->where, item.variable->text,
                              "is a variable, which only an FMU or a program has");
      }
    }
  };
  refuse(collectSampled(model));
  refuse(model.constants);
  refuse(model.excitation);
  if (elsewhere) {
    checkSourceFiles(*model.source, model.parameters.front().name.where.file);
  }
  const InitialSpec& initial = model.initial;
  if (elsewhere && (!initial.coordinates.empty() || !initial.speeds.empty() || initial.equilibrium)) {
    throw ExperimentError(
        {model.parameters.front().name.where.file, 0, 0, "initial"}, "",
        "is for a system; set the start values of a model from elsewhere by constants with a variable");
  }
}

}  // namespace twinmap
