#pragma once

#include "framework/models/fmu/package/model_description.hpp"
#include "framework/models/fmu/package/xml_values.hpp"

namespace twinmap::fmi {

/// The variables of <ModelVariables>, FMI 2.0 and 3.0, in their order; aliases of FMI 3.0 as variables of
/// their own at the end. `root`: <fmiModelDescription>.
std::vector<Variable> readVariables2(const pugi::xml_node& root, const XmlFile& file);
std::vector<Variable> readVariables3(const pugi::xml_node& root, const XmlFile& file);

/// `initial` where the model description leaves it out: the table of section 2.2.7 of FMI 2.0 and 2.4.7.5 of
/// FMI 3.0.
Initial chooseInitial(Causality causality, Variability variability);

/// Attributes that both versions write alike: causality, variability, initial, unit, start, min, max ...
/// `typed`: the element with the attributes of the type; `type_node`: its declared type, or an empty node.
void readAttributes(const pugi::xml_node& node, const pugi::xml_node& typed, const pugi::xml_node& type_node,
                    const XmlFile& file, Variable& variable);

}  // namespace twinmap::fmi
