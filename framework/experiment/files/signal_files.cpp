#include "framework/experiment/files/signal_files.hpp"

#include <algorithm>
#include <filesystem>

namespace twinmap {
namespace {

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Calls visit() with every node at `keys`, a path through maps in which "*" stands for any key or item.
template <class Visit>
void visitNodes(YamlNode& node, const char* const* keys, const char* const* end, const Visit& visit) {
  if (keys == end) {
    visit(node);
    return;
  }
  const std::string key = *keys;
  for (YamlEntry& entry : node.entries) {
    if (key == "*" || key == entry.key) {
      visitNodes(entry.value, keys + 1, end, visit);
    }
  }
  for (YamlNode& item : node.items) {
    if (key == "*") {
      visitNodes(item, keys + 1, end, visit);
    }
  }
}

}  // namespace

void resolveSignalFiles(YamlNode& root, const std::string& path) {
  if (YamlNode* trials = root.find("trials")) {
    for (YamlEntry& trial : trials->entries) {
      resolveSignalFiles(trial.value, path);
    }
  }
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const auto resolve = [&](YamlNode& file) {
    if (file.kind == YamlNode::Kind::kScalar && !file.scalar.empty()) {
      file.scalar = (folder / file.scalar / "").lexically_normal().parent_path().string();
    }
  };
  constexpr const char* kFile[] = {"excitation", "*", "tables", "*", "measured", "file"};
  visitNodes(root, std::begin(kFile), std::end(kFile), resolve);
  constexpr const char* kFmu[] = {"model", "fmu", "file"};
  visitNodes(root, std::begin(kFmu), std::end(kFmu), resolve);
  constexpr const char* kMesh[] = {"system", "bodies", "*", "shapes", "*", "mesh"};
  visitNodes(root, std::begin(kMesh), std::end(kMesh), resolve);
  constexpr const char* kProgram[] = {"model", "program"};
  visitNodes(root, std::begin(kProgram), std::end(kProgram), [&](YamlNode& program) {
    if (program.kind == YamlNode::Kind::kMap && program.find("working_folder") == nullptr) {
      program.entries.push_back({"working_folder", program.where, makeScalar(".")});
      program.entries.back().value.where = program.where;
    }
  });
  constexpr const char* kFolder[] = {"model", "program", "working_folder"};
  visitNodes(root, std::begin(kFolder), std::end(kFolder), resolve);
  constexpr const char* kSwept[] = {"sweep", "over"};
  visitNodes(root, std::begin(kSwept), std::end(kSwept), [&](YamlNode& over) {
    for (YamlEntry& swept : over.entries) {
      if ((endsWith(swept.key, ".measured.file") || swept.key == "model.fmu.file")) {
        std::for_each(swept.value.items.begin(), swept.value.items.end(), resolve);
      }
    }
  });
}

}  // namespace twinmap
