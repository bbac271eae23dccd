#pragma once

#include <string>

#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap {

/// Makes the names of files of measured signals (excitation.*.tables[*].measured.file, also where they are
/// swept), of meshes, of an FMU and of a program's working folder, which it adds where none is given,
/// absolute: they are relative to the folder of the experiment file `path`.
void resolveSignalFiles(YamlNode& root, const std::string& path);

}  // namespace twinmap
