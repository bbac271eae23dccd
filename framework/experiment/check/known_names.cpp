#include "framework/experiment/check/known_names.hpp"

#include <algorithm>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap {

void requireKnown(const Name& name, const std::vector<std::string>& known, const std::string& what) {
  if (std::find(known.begin(), known.end(), name.text) == known.end()) {
    throw ExperimentError(name.where, name.text, "is not " + what + suggestName(name.text, known));
  }
}

}  // namespace twinmap
