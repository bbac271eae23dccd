#pragma once

#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"

namespace twinmap {

/// Throws ExperimentError unless `name` is one of `known`; `what` says what it should be ("a body").
void requireKnown(const Name& name, const std::vector<std::string>& known, const std::string& what);

/// The texts of the `name` members.
template <class T>
std::vector<std::string> collectNames(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) {
    names.push_back(item.name.text);
  }
  return names;
}

}  // namespace twinmap
