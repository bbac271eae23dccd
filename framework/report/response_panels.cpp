#include "framework/report/response_panels.hpp"

namespace twinmap {
namespace {

Texts makeTexts(const ResponseData& data) {
  return {{"table", data.table},
          {"output", data.output},
          {"label", makeLabel(data.output, data.unit)},
          {"case", data.which},
          {"measured", data.measured},
          {"of_case", data.which.empty() ? "" : ", " + data.which + " case"}};
}

std::set<std::string> findMissingData(const ResponseData& data, const ResponseLook& look) {
  std::set<std::string> missing;
  if (data.which.empty()) {
    missing.insert("case");
  }
  if (!look.zoom) {
    missing.insert("zoom");
  }
  return missing;
}

}  // namespace

Panel makeResponsePanel(const ResponseData& data, const ResponseLook& look) {
  Panel panel{"response", makeTexts(data), {}, findMissingData(data, look)};
  if (!look.band) {
    panel.without.insert("band");
  }
  return panel;
}

Panel makeResidualPanel(const ResponseData& data, const ResponseLook& look) {
  return {"residual", makeTexts(data), {}, findMissingData(data, look)};
}

}  // namespace twinmap
