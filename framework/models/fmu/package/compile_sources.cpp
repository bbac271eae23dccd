#include "framework/models/fmu/package/compile_sources.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "framework/base/text/source_location.hpp"
#include "framework/base/worker/run_program.hpp"
#include "framework/models/fmu/package/standard_headers.hpp"
#include "framework/models/fmu/package/xml_values.hpp"

namespace twinmap::fmi {
namespace {

namespace fs = std::filesystem;

/// What is compiled, and how.
struct Build {
  std::vector<std::string> sources, options, libraries;
};

[[noreturn]] void fail(const SourceTree& tree, const std::string& rule) {
  throw ExperimentError(tree.fmu + ": " + rule);
}

std::string requireInside(const SourceTree& tree, const std::string& name) {
  const fs::path path(name);
  if (path.is_absolute() ||
      std::any_of(path.begin(), path.end(), [](const fs::path& p) { return p == ".."; })) {
    fail(tree, "its source '" + name + "' lies outside sources/");
  }
  return name;
}

void addDefinitions(const pugi::xml_node& set, Build& build) {
  for (const pugi::xml_node& definition : set.children("PreprocessorDefinition")) {
    const std::string value = definition.attribute("value").value();
    if (!findFlag(definition, "optional") || !value.empty()) {
      build.options.push_back("-D" + std::string(definition.attribute("name").value()) +
                              (value.empty() ? "" : "=" + value));
    }
  }
}

void addSourceSet(const SourceTree& tree, const pugi::xml_node& set, Build& build) {
  const std::string language = set.attribute("language").value();
  if (!language.empty() && language.rfind("C", 0) == 0 && language.rfind("C++", 0) == 0) {
    fail(tree, "its sources are in " + language + "; only C is compiled");
  }
  for (const pugi::xml_node& file : set.children("SourceFile")) {
    build.sources.push_back(requireInside(tree, file.attribute("name").value()));
  }
  addDefinitions(set, build);
  for (const pugi::xml_node& folder : set.children("IncludeDirectory")) {
    build.options.push_back("-I" + requireInside(tree, folder.attribute("name").value()));
  }
}

/// False if there is no buildDescription.xml.
bool readBuildDescription(const SourceTree& tree, Build& build) {
  pugi::xml_document document;
  const fs::path xml = tree.folder / "buildDescription.xml";
  if (!fs::exists(xml)) {
    return false;
  }
  if (const pugi::xml_parse_result result = document.load_file(xml.c_str()); !result) {
    fail(tree, "sources/buildDescription.xml is not XML: " + std::string(result.description()));
  }
  for (const pugi::xml_node& configuration :
       document.child("fmiBuildDescription").children("BuildConfiguration")) {
    const std::string identifier = configuration.attribute("modelIdentifier").value();
    if (identifier != tree.capabilities.model_identifier) {
      continue;
    }
    for (const pugi::xml_node& set : configuration.children("SourceFileSet")) {
      addSourceSet(tree, set, build);
    }
    for (const pugi::xml_node& library : configuration.children("Library")) {
      build.libraries.push_back("-l" + std::string(library.attribute("name").value()));
    }
    return true;
  }
  fail(tree, "sources/buildDescription.xml has no configuration of " + tree.capabilities.model_identifier);
}

Build readBuild(const SourceTree& tree) {
  Build build;
  if (!readBuildDescription(tree, build)) {
    for (const std::string& source : tree.capabilities.source_files) {
      build.sources.push_back(requireInside(tree, source));
    }
  }
  if (build.sources.empty()) {
    fail(tree, "has no library for this platform, and lists no sources to compile");
  }
  return build;
}

std::vector<std::string> composeCommand(const SourceTree& tree, const Build& build, const fs::path& headers,
                                        const fs::path& library) {
  std::vector<std::string> command{getCompiler(), "-shared", "-fPIC", "-O2", "-w", "-I."};
  if (tree.version == Version::k3) {
    command.emplace_back("-DFMI3_OVERRIDE_FUNCTION_PREFIX");  // names in a library of its own have no prefix
  }
  command.insert(command.end(), build.options.begin(), build.options.end());
  command.push_back("-I" + headers.string());
  command.insert(command.end(), build.sources.begin(), build.sources.end());
  command.insert(command.end(), {"-o", library.string()});
  command.insert(command.end(), build.libraries.begin(), build.libraries.end());
  command.emplace_back("-lm");
  return command;
}

std::string readBeginning(const fs::path& path) {
  constexpr std::size_t kMax = 1000;  // characters: the first errors
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str().substr(0, kMax);
}

}  // namespace

std::string getCompiler() {
  const char* own = std::getenv("CC");
  return own != nullptr && *own != '\0' ? own : "cc";
}

bool compileSources(const SourceTree& tree, const fs::path& library) {
  const Build build = readBuild(tree);
  const fs::path headers = library.parent_path() / "fmi-headers",
                 log = library.parent_path() / "compiler.log";
  writeStandardHeaders(headers);
  const std::vector<std::string> command = composeCommand(tree, build, headers, library);
  const int status = runProgram(command, tree.folder, log);
  const bool started = status != -1 && status != 127;
  if (started && status != 0) {
    fs::remove(library);
    fail(tree, "its sources do not compile:\n" + readBeginning(log));
  }
  return started;
}

}  // namespace twinmap::fmi
