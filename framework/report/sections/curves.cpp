#include <fmt/core.h>

#include <algorithm>

#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kCurves = "curves";

DataTable makeCurveTable(const CsvTable& curves) {
  DataTable table;
  for (const char* column : {"curve", "sample"}) {
    table.add(column, curves.listTexts(column));
  }
  for (const char* column : {"argument", "true", "inferred", "lower", "upper"}) {
    table.add(column, curves.listNumbers(column));
  }
  return table;
}

Panel makeCurvePanel(const CurveSpec& curve, const std::string& sample, std::size_t index) {
  return {"curve",
          {{"name", curve.name.text},
           {"sample", sample},
           {"label", makeLabel(curve.name.text, curve.unit)},
           {"over", curve.over.text},
           {"color", getColor(index)}}};
}

}  // namespace

void addCurves(const RunFolder& run, Page& page) {
  if (run.curves.empty()) {
    return;
  }
  page.tables[kCurves] = makeCurveTable(run.curves);
  Section section{kCurves, "Curves", "", {}};
  const std::vector<std::string> names = run.curves.listDistinct("curve");
  const std::vector<std::string> samples = run.curves.listDistinct("sample");
  std::size_t index = 0;
  for (const CurveSpec& curve : run.experiment.model.system.curves) {
    if (std::find(names.begin(), names.end(), curve.name.text) == names.end()) {
      continue;
    }
    Figure figure{fmt::format("curve-{}", index),
                  fmt::format("{} over {}", curve.name.text, curve.over.text),
                  "Dashed: the true curve of a test sample; solid: the estimated one. At each point the band "
                  "is the 95 % interval.",
                  kCurves,
                  {},
                  {},
                  static_cast<int>(samples.size() > 1 ? samples.size() : 0)};
    for (const std::string& sample : samples) {
      figure.panels.push_back(makeCurvePanel(curve, sample, index));
    }
    addFigure(std::move(figure), section);
    ++index;
  }
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
