#pragma once

#include <string>
#include <vector>

#include "framework/experiment/tree/sweep_spec.hpp"

namespace twinmap {

/// Reads a map from key paths to lists of values or ranges. Throws ExperimentError for an empty list or
/// value, a malformed range, a value given twice, a key that cannot be swept, or keys of which one is part of
/// another.
void readValue(const YamlNode& node, SweptKeys& value);

/// Ranges are written as lists.
YamlNode writeValue(const SweptKeys& value);

/// Whether a text is meant as a range of whole numbers: "1..10"; also a malformed one such as "1..".
bool isRange(const std::string& text);

/// Whether a sweep may vary the key: not the name, descriptions, and the sweep itself.
bool isSweepable(const std::string& key);

}  // namespace twinmap
